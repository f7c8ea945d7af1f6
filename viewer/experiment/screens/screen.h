#pragma once
// The participant's screen: a window, the walls of a display, or a headset. The time of each swap is measured.

#include "viewer/devices/gl/input_event.h"
#include "viewer/displays/display_light.h"
#include "viewer/displays/stereo_mode.h"
#include "viewer/engine/live/live_renderer.h"
#include "viewer/experiment/gaze/gaze_source.h"

#include <functional>

namespace viewer {

/// A place on the screen with a picture. On walls there is only one: each wall shows its views of it.
struct ScreenPane {
    glm::ivec2 corner_px{}, size_px{}; ///< from the window's top left corner
    std::shared_ptr<LiveFrame const> frame;
    StereoMode stereo = StereoMode::off;
    DisplayLight light{}; ///< of a calibrated display
    /// Poses for which its surfaces are drawn with the light of the frame; none = it is shown as it was rendered.
    std::optional<FrameCommand> moment{};
    std::size_t stimulus = 0; ///< with a moment: its number, by which the screen keeps what it draws
};

/// The views as they are shown. The pane must have a frame.
inline std::vector<ViewCommand> const& views_of(ScreenPane const& pane)
{
    return pane.moment ? pane.moment->views : pane.frame->command.views;
}

/// A circle that follows the participant's gaze: pictures are visible only within it, or everywhere else;
/// the rest is the background.
struct GazeCircle {
    bool is_window = true;            ///< else a mask
    glm::vec2 centre_px{};            ///< from the window's top left corner
    float radius_px = 0, edge_px = 1; ///< the edge is soft, half of it within the radius
};

/// Content shown by one swap.
struct ScreenContent {
    static constexpr float kGrey = 0.5f; ///< background, display-encoded
    std::vector<ScreenPane> panes;
    std::optional<GazeCircle> gaze;
    std::function<void(glm::vec2 size_px)> text;   ///< ImGui's calls; empty = none
    glm::ivec2 patch_corner_px{}, patch_size_px{}; ///< of the square for a photodiode; size 0 = none
    bool patch_is_white = false;
};

/// Onset time of a swap.
struct ScreenSwap {
    InputEvent::Clock::time_point time; ///< best estimate
    InputEvent::Clock::time_point seen; ///< for counting dropped frames, as in SwapTime
    double uncertainty_ms = 0;
    char const* method = "swap_finish"; ///< oml, swap_finish, openxr_predicted
    std::vector<char> drawn{};          ///< per pane: its surfaces were drawn for its moment
    double drawn_scale = 0;             ///< of surfaces, as Viewpoint::drawn_scale; 0 = they cannot be drawn
};

class Screen {
public:
    virtual ~Screen() = default;

    virtual glm::ivec2 size_px() const = 0; ///< of the window with text
    virtual double refresh_hz() const = 0;  ///< 0 = unknown
    /// Provenance entries: display, opengl, ...
    virtual std::vector<std::pair<std::string, std::string>> about() const = 0;

    /// Brings the scene of a pane with a moment to the GPU, so that its surfaces can be drawn from its onset on. Shows
    /// nothing.
    virtual void make_ready(ScreenPane const& pane) = 0;
    /// Shows the content, reading input meanwhile. Throws InputError if the display is lost.
    virtual ScreenSwap present(ScreenContent const& content) = 0;
    /// Reads input until this time.
    virtual void wait_until(InputEvent::Clock::time_point time) = 0;
    /// Events since the last call, in order, with their times.
    virtual std::vector<InputEvent> take_input() = 0;
    /// Longest time between two reads of input since the last call, ms: bounds the delay of event times.
    virtual double take_longest_look_ms() = 0;

    /// The window on its monitor, for gaze.
    virtual GazePlace gaze_place() const = 0;

    /// Gaze that the screen itself has measured since the last call; pixels from the centre, as in gaze_place.
    virtual std::vector<study::GazeSample> take_gaze() { return {}; }
    virtual std::vector<std::pair<std::string, std::string>> gaze_about() const { return {}; }

    /// True if the screen defines its own views (walls or headset eyes, from tracked heads).
    /// Then it shows one stimulus at a time.
    virtual bool has_own_views() const = 0;
    /// The screen's own views for the head poses predicted for a time.
    /// @param world_from_camera  camera at the first user's resting head; of its rotation only the yaw counts
    /// @param steady_s  std::chrono::steady_clock
    virtual std::vector<ViewCommand> own_views(gi::dmat4 const& world_from_camera, double steady_s) = 0;
};

} // namespace viewer
