#pragma once
// What a head-mounted display asks for and is given, frame by frame. Frame "room": right-handed, m, +Y up, the
// floor at 0; heads, eyes and hands look along -Z. Times are seconds of std::chrono::steady_clock.

#include "gi/scene/model/camera.h"
#include "viewer/protocol/frame_command.h"

#include <array>
#include <cstdint>
#include <string>

namespace viewer {

enum class HmdEye { left = 0, right = 1 };

/// A pose and a field of view as the runtime gave them, in its own space: what a picture is handed back with, so
/// that the runtime can bring it to where the head is when it is seen. Bit for bit, whatever was recentred since.
struct HmdRawView {
    std::array<float, 4> rotation{0, 0, 0, 1}; ///< x, y, z, w; unit
    std::array<float, 3> position{0, 0, 0};    ///< m
    std::array<float, 4> fov_rad{0, 0, 0, 0};  ///< left, right, up, down; left and down are negative

    bool operator==(HmdRawView const&) const = default;
};

/// One eye of a frame.
struct HmdView {
    gi::Camera camera;         ///< in the room, off-axis: the tangents of the runtime's four angles
    int width = 0, height = 0; ///< pixels that the runtime recommends
    HmdRawView raw;
    std::uint64_t space = 0; ///< how often the runtime has moved its space; for the session

    bool operator==(HmdView const&) const = default;
};

/// One controller. Its pose is empty while nobody knows it. Without a controller or the focus nothing is pressed.
struct HmdHand {
    std::string profile; ///< that the runtime has bound, "/interaction_profiles/..."; empty = no controller
    std::optional<RoomPose> aim; ///< a pointing ray starts at its position and goes along its -Z
    glm::dvec2 move{0};          ///< thumb stick or track pad, -1 to 1: right, away from the user
    bool select = false;  ///< the button for an answer: A, X, track pad; on simple controllers their only one
    bool trigger = false; ///< pulled as far as the runtime wants; where there is none, select
    bool menu = false;

    bool operator==(HmdHand const&) const = default;
};

struct HmdFrame {
    std::uint64_t frame = 0;    ///< of this session, from 0
    double display_s = 0;       ///< when it is predicted to be seen; poses are those of this time
    double pose_s = 0;          ///< when the runtime was asked for the poses
    double period_s = 0;        ///< of the display; 0 where the runtime does not tell
    std::int64_t xr_time = 0;   ///< display_s on the clock of the runtime, ns
    bool should_render = false; ///< false: nobody will see it; end the frame all the same
    bool has_pose = false;      ///< false: the head is not tracked, and views are those of the last pose known
    std::array<HmdView, 2> views;
    Tracked tracked; ///< head, and the grips of the controllers
    std::array<HmdHand, 2> hands;
};

/// Whether numbers in a texture are light or its sRGB code. Textures of the format GL_SRGB8_ALPHA8 are `linear`,
/// since reading them decodes.
enum class TextureValues { linear, srgb };
enum class FirstRow { bottom, top };

/// A finished picture of both eyes, with the views that it was drawn for; these may be older than the frame it is
/// handed to.
struct HmdPicture {
    std::array<HmdView, 2> views;
    std::array<unsigned, 2> textures{}; ///< GL names of 2D textures of any size, values 0 to 1, alpha ignored
    TextureValues values = TextureValues::linear;
    FirstRow first_row = FirstRow::bottom;
};

} // namespace viewer
