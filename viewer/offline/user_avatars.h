#pragma once
// Which users have avatars, as options, display files and recordings say it; scenes with them.

#include "viewer/displays/display.h"
#include "viewer/offline/render_options.h"
#include "viewer/offline/replay.h"

namespace viewer {

struct AvatarChoice {
    std::size_t user = 0;
    std::string file;        ///< of a skinned model, or the name of a generated one
    double eye_height_m = 0; ///< of the user standing
    bool on_floor = true;    ///< y = 0 of his room is what he stands on; else his feet are not asked for

    bool operator==(AvatarChoice const&) const = default;
};

/// Those of --avatar (the first user's, before what the display says) and of a display, by user.
/// @param eye_height_m  of who does not say it, nor where his head rests   @param folder  of the display's file
std::vector<AvatarChoice> avatar_choices(std::string const& avatar, double eye_height_m,
                                         std::optional<Display> const& display,
                                         std::filesystem::path const& folder);
/// Of a user standing; rooms whose origin is not on the floor do not tell.
double standing_eye_height_m(std::optional<Display> const& display, std::size_t user, double otherwise_m);
/// How far above the floor the first user's head rests: there the room hangs from the navigation's camera.
double resting_eye_height_m(std::optional<Display> const& display, double otherwise_m);

/// What a recording keeps of them among what its scenes are read with, and back.
void put_avatars(nlohmann::json& load, std::vector<AvatarChoice> const& avatars);
/// Throws InputError where a recording has them otherwise.
std::vector<AvatarChoice> avatars_of(nlohmann::json const& load);

/// Scenes as the options say, each with all of these avatars. Throws InputError where one is none.
RecordedScenes scenes_with(RenderOptions const& options, std::vector<AvatarChoice> const& avatars,
                           gi::Report& report);

} // namespace viewer
