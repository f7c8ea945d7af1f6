#pragma once
// Frame commands: everything that determines the pixels of one frame of the viewer, and nothing else. The same
// sequence of commands renders the same pixels in any process. The live viewer makes one command per frame, a
// recording stores them, the leading rank of a cluster sends them, and a replay reads them.

#include "gi/core/pose.h"
#include "gi/scene/model/camera.h"

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer {

/// A value set by a key, the panel, the remote protocol or a script. Keys are those of viewer/engine/settings.h,
/// scene_edits.h and hidden_mask.h ("exposure", "light.0.intensity", "object.door.position").
struct Change {
    std::string key;
    nlohmann::json value;

    bool operator==(Change const&) const = default;
};

/// Pose of a body in the room.
using RoomPose = gi::RigidPose;

/// Tracked bodies of a user; those that are not tracked (yet, or any more) have no pose.
struct Tracked {
    std::optional<RoomPose> head, left_hand, right_hand;
    std::optional<RoomPose> left_foot{}, right_foot{}; ///< at the sole below the ankle, -Z along the toes

    bool operator==(Tracked const&) const = default;
};
/// Names of the bodies, in their order in messages, files and tables.
inline constexpr std::array<char const*, 5> kBodyNames{"head", "left_hand", "right_hand", "left_foot",
                                                       "right_foot"};
inline constexpr std::array kBodyMembers{&Tracked::head, &Tracked::left_hand, &Tracked::right_hand,
                                         &Tracked::left_foot, &Tracked::right_foot};

/// One view of a frame: an eye at a wall, a window, an eye of a head-mounted display.
struct ViewCommand {
    std::string name;          ///< "left wall, right eye"
    gi::Camera camera;         ///< in the world
    int width = 0, height = 0; ///< pixels to render
    /// An earlier view of this frame that sees nearly the same, whose light is reused; -1 = none.
    int partner = -1;
    int margin_x = 0, margin_y = 0; ///< pixels beyond each edge that the picture shows too, because the head turns
                                    ///< while it is seen; only where light_scale is below 1

    bool operator==(ViewCommand const&) const = default;
};

struct FrameCommand {
    std::uint64_t frame = 0;
    double pose_s = 0;            ///< when the poses were measured, on the session's clock, which starts at 0
    double display_s = 0;         ///< expected display time, on the same clock
    double scene_s = 0;           ///< time of the scene's animations
    gi::dmat4 world_from_room{1}; ///< navigation: rigid, with a scale if the user is larger or smaller
    Tracked tracked;              ///< of the first user
    std::vector<Tracked> others;  ///< of the following users; only those with an avatar
    std::vector<Change> changes;  ///< since the previous frame, in order
    std::vector<ViewCommand> views;
    int paths = 1;            ///< per pixel of the pictures of light
    double light_scale = 1;   ///< side of the pictures of light over that of the views, in (0, 1]
    double surface_scale = 1; ///< side of the pictures of surfaces over that of the views, in [light_scale, 1];
                              ///< only where light_scale is below 1
    bool only_light =
        false; ///< others draw the surfaces: pictures have the size of light, or that of surfaces, sharp in
               ///< those mirrors and panes alone that others do not draw; only where light_scale is below 1

    bool operator==(FrameCommand const&) const = default;
};

/// Limits of a frame command; input is checked against them before memory is allocated.
struct CommandLimits {
    static constexpr std::size_t views = 256, users = 64, changes = 65536, name_bytes = 4096,
                                 value_bytes = 1 << 20, bytes = 1 << 26;
    static constexpr int size_px = 16384, paths = 1 << 24, value_depth = 32;
};

/// Throws InputError if a command cannot be rendered: non-finite numbers, a matrix that is not affine or is
/// singular, rotations that are not unit, views without a size, a partner that is not an earlier view, a lens that
/// gi::check_lens rejects, or anything beyond CommandLimits.
void check_command(FrameCommand const& command);

/// Encodes doubles with all bits and omits default values: about 150 bytes for a desktop's frame, 120 more for
/// each further view. The first byte is the format version. Throws InputError as check_command does.
std::vector<std::uint8_t> to_bytes(FrameCommand const& command);
/// Inverse of to_bytes. Throws InputError on any other bytes.
FrameCommand command_from_bytes(std::span<std::uint8_t const> bytes);

} // namespace viewer
