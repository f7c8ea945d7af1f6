#pragma once
// Per-frame data exchanged with a head-mounted display. Frame "room": right-handed, m, +Y up, the floor at 0;
// heads, eyes and hands look along -Z. Times are seconds of std::chrono::steady_clock.

#include "gi/scene/model/camera.h"
#include "viewer/devices/gl/shown_depth.h"
#include "viewer/protocol/frame_command.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

enum class HmdEye { left = 0, right = 1 };

/// Pose and field of view as given by the runtime, in its own space. They are returned with the picture, so that
/// the runtime can reproject it to the head pose at display time. Kept bit for bit, also after recentring.
struct HmdRawView {
    std::array<float, 4> rotation{0, 0, 0, 1}; ///< x, y, z, w; unit
    std::array<float, 3> position{0, 0, 0};    ///< m
    std::array<float, 4> fov_rad{0, 0, 0, 0};  ///< left, right, up, down; left and down are negative

    bool operator==(HmdRawView const&) const = default;
};

/// What an eye sees in a frame, or the middle of it.
struct HmdView {
    gi::Camera camera;         ///< in the room, off-axis: the tangents of the runtime's four angles
    int width = 0, height = 0; ///< pixels that the runtime recommends
    HmdRawView raw;
    std::uint64_t space = 0; ///< number of times the runtime had moved its space; used by the session
    double pose_s = 0;       ///< when its pose was requested

    bool operator==(HmdView const&) const = default;
};

/// One controller. Poses are empty while unknown. Without a controller or the focus, nothing is pressed.
struct HmdHand {
    std::string profile;         ///< bound by the runtime, "/interaction_profiles/..."; empty = no controller
    std::optional<RoomPose> aim; ///< pointing ray: starts at the position, along -Z
    glm::dvec2 move{0};          ///< thumb stick or track pad, -1 to 1: right, away from the user
    bool select = false;         ///< answer button: A, X, track pad; the only button of simple controllers
    bool trigger = false;        ///< pulled beyond the runtime's threshold; select if there is no trigger
    bool menu = false;

    bool operator==(HmdHand const&) const = default;
};

/// Where both eyes together look, by the headset's eye tracker.
struct HmdGaze {
    double time_s = 0;     ///< when it was measured; of the question, if the runtime does not say
    bool is_valid = false; ///< false: a blink, or the eyes were not found
    glm::dvec2 tangent{0}; ///< direction from the head's forward one: to the right, up
    bool operator==(HmdGaze const&) const = default;
};

struct HmdFrame {
    std::uint64_t frame = 0;    ///< of this session, from 0
    double display_s = 0;       ///< predicted display time, for which the poses are predicted
    double pose_s = 0;          ///< when the poses were requested
    double period_s = 0;        ///< of the display; 0 if unknown
    std::int64_t xr_time = 0;   ///< display_s on the clock of the runtime, ns
    bool should_render = false; ///< false: it will not be visible; end the frame nevertheless
    bool has_pose = false;      ///< false: the head is not tracked, and views are from the last known pose
    /// Of the left and the right eye; with insets, then the middle of each with finer pixels.
    std::vector<HmdView> views;
    Tracked tracked; ///< head, and the grips of the controllers
    std::array<HmdHand, 2> hands;
    std::optional<HmdGaze> gaze; ///< none without eye tracking, or while the session has no focus
};

/// Encoding of texture values: linear or sRGB. Textures of format GL_SRGB8_ALPHA8 are `linear`,
/// because reading decodes them.
enum class TextureValues { linear, srgb };
enum class FirstRow { bottom, top };

/// A finished picture of both eyes and the views that it was drawn for, which may be older
/// than the frame that it is submitted to.
struct HmdPicture {
    std::vector<HmdView> views;     ///< as many as a frame has
    std::vector<unsigned> textures; ///< GL names of 2D textures of any size, values 0 to 1, alpha ignored
    std::vector<ShownDepth> depths; ///< of the views, any size; empty, or one without a texture: not submitted
    TextureValues values = TextureValues::linear;
    FirstRow first_row = FirstRow::bottom;
};

} // namespace viewer
