#pragma once
// Avatars of users, from options, display files and recordings, and scenes with these avatars.

#include "viewer/app/replay.h"
#include "viewer/displays/display.h"
#include "viewer/offline/render_options.h"

namespace viewer {

struct AvatarChoice {
    std::size_t user = 0;
    std::string file;        ///< skinned model file, or name of a built-in avatar
    double eye_height_m = 0; ///< of the standing user
    bool on_floor = true;    ///< the user stands at y = 0 of the room; otherwise the feet are not used
    std::string joints{};    ///< joint map (gi/scene/motion/avatar_map.h); empty = by usual names

    bool operator==(AvatarChoice const&) const = default;
};

/// Avatars of --avatar (first user, overriding the display) and of a display, in the order of users.
/// @param eye_height_m  for users without an eye height or resting head   @param folder  that of the display file
/// @param joints  joint map of `avatar`
std::vector<AvatarChoice> avatar_choices(std::string const& avatar, double eye_height_m,
                                         std::optional<Display> const& display,
                                         std::filesystem::path const& folder, std::string const& joints = {});
/// Eye height of a standing user; `otherwise_m` if the display does not give it or its origin is not on the floor.
double standing_eye_height_m(std::optional<Display> const& display, std::size_t user, double otherwise_m);
/// Height of the first user's resting head above the floor, where the room is attached to the navigation camera.
double resting_eye_height_m(std::optional<Display> const& display, double otherwise_m);

/// Write avatars to the scene options of a recording, and read them back.
void put_avatars(nlohmann::json& load, std::vector<AvatarChoice> const& avatars);
/// Throws InputError if the recording's avatars are invalid.
std::vector<AvatarChoice> avatars_of(nlohmann::json const& load);

/// Scenes by the options, each with all of these avatars. Throws InputError if a file is no avatar.
RecordedScenes scenes_with(RenderOptions const& options, std::vector<AvatarChoice> const& avatars,
                           gi::Report& report);

} // namespace viewer
