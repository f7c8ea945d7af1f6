#pragma once
// Everything that decides the pixels of one frame of the viewer, and nothing else: who is given the same orders in
// the same sequence renders the same pixels. The live viewer makes an order per frame, a recording keeps them, the
// leading rank of a cluster sends them, a replay reads them.

#include "gi/scene/model/camera.h"

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer {

/// Something that was set: by a key, the panel, the remote protocol, a script. Keys are those of
/// viewer/engine/settings.h ("exposure", "light.0.intensity", "object.door.position").
struct Change {
    std::string key;
    nlohmann::json value;

    bool operator==(Change const&) const = default;
};

/// A rigid place in the room: right-handed, m, +Y up; heads, hands and feet look along -Z.
struct RoomPose {
    gi::dvec3 position{0};          ///< m
    gi::dquat rotation{1, 0, 0, 0}; ///< unit, room from body

    bool operator==(RoomPose const&) const = default;
};

/// Bodies that are tracked; those that are not (yet, or any more) have no pose.
struct Tracked {
    std::optional<RoomPose> head, left_hand, right_hand;
    std::optional<RoomPose> left_foot{}, right_foot{}; ///< at the sole below the ankle, -Z along the toes

    bool operator==(Tracked const&) const = default;
};
/// Names of the bodies, in the order in which messages, files and tables have them.
inline constexpr std::array<char const*, 5> kBodyNames{"head", "left_hand", "right_hand", "left_foot",
                                                       "right_foot"};
inline constexpr std::array kBodyMembers{&Tracked::head, &Tracked::left_hand, &Tracked::right_hand,
                                         &Tracked::left_foot, &Tracked::right_foot};

/// One picture of a frame: an eye before a wall, a window, a lens of a head-mounted display.
struct ViewCommand {
    std::string name;          ///< "left wall, right eye"
    gi::Camera camera;         ///< in the world
    int width = 0, height = 0; ///< pixels to render
    int partner = -1; ///< an earlier view of this frame that sees nearly the same: light found there is reused; -1
                      ///< = none

    bool operator==(ViewCommand const&) const = default;
};

struct FrameCommand {
    std::uint64_t frame = 0;
    double pose_s = 0;            ///< when the poses were taken, on the clock of the session, which starts at 0
    double display_s = 0;         ///< when it was expected to be seen, on the same clock
    double scene_s = 0;           ///< time of the scene's animations
    gi::dmat4 world_from_room{1}; ///< navigation: rigid, and a scale where the user is larger or smaller
    Tracked tracked;              ///< of the first user
    std::vector<Tracked> others;  ///< of the users after him; nothing of those who have no avatar
    std::vector<Change> changes;  ///< since the frame before, in order
    std::vector<ViewCommand> views;
    int paths = 1; ///< per pixel

    bool operator==(FrameCommand const&) const = default;
};

/// What an order may hold at most; whatever is read is held to it before memory is taken.
struct CommandLimits {
    static constexpr std::size_t views = 256, users = 64, changes = 65536, name_bytes = 4096,
                                 value_bytes = 1 << 20, bytes = 1 << 26;
    static constexpr int size_px = 16384, paths = 1 << 24, value_depth = 32;
};

/// Throws InputError on an order that nothing can render: numbers that are not finite, a matrix that is not affine
/// or flattens, rotations that are not unit, views without a size, a partner that is no earlier view, a lens that
/// gi::check_lens refuses, or more than CommandLimits.
void check_command(FrameCommand const& order);

/// Every double in all its bits, what has its default value left out: about 150 bytes for a desktop's frame, 120
/// more for each further view. The first byte is the version of the form. Throws InputError as check_command.
std::vector<std::uint8_t> to_bytes(FrameCommand const& order);
/// The order that to_bytes was given. Throws InputError on anything else.
FrameCommand command_from_bytes(std::span<std::uint8_t const> bytes);

} // namespace viewer
