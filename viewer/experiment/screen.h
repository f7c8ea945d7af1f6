#pragma once
// What a participant looks at: a window, the walls of a display, or a headset. Each swap has its time.

#include "viewer/devices/gl/input_event.h"
#include "viewer/displays/stereo_mode.h"
#include "viewer/engine/live/live_renderer.h"

#include <functional>

namespace viewer {

/// A place of the screen with a picture in it. On walls one of them is all there is: each wall shows its views.
struct ScreenPane {
    glm::ivec2 corner_px{}, size_px{}; ///< from the window's top left corner
    std::shared_ptr<LiveFrame const> frame;
    StereoMode stereo = StereoMode::off;
};

/// Everything that one swap shows.
struct ScreenContent {
    static constexpr float kGrey = 0.5f; ///< of the background, display-encoded
    std::vector<ScreenPane> panes;
    std::function<void(glm::vec2 size_px)> text;   ///< ImGui's calls; empty = none
    glm::ivec2 patch_corner_px{}, patch_size_px{}; ///< of the square for a photodiode; size 0 = none
    bool patch_is_white = false;
};

/// When something was seen first.
struct ScreenSwap {
    InputEvent::Clock::time_point time; ///< best guess
    InputEvent::Clock::time_point seen; ///< what dropped frames are counted by: as SwapTime
    double uncertainty_ms = 0;
    char const* method = "swap_finish"; ///< oml, swap_finish, openxr_predicted
};

class Screen {
public:
    virtual ~Screen() = default;

    virtual glm::ivec2 size_px() const = 0; ///< of the window that has text
    virtual double refresh_hz() const = 0;  ///< 0 = unknown
    /// Provenance: display, opengl, ...
    virtual std::vector<std::pair<std::string, std::string>> about() const = 0;

    /// Shows it, reads input meanwhile. Throws InputError where the display is lost.
    virtual ScreenSwap present(ScreenContent const& content) = 0;
    /// Reads input until then.
    virtual void wait_until(InputEvent::Clock::time_point time) = 0;
    /// Everything since the last call, in order, with the time of each.
    virtual std::vector<InputEvent> take_input() = 0;
    /// Longest time between two looks at the input since the last call, ms: what its times may be late by.
    virtual double take_longest_look_ms() = 0;

    /// One stimulus at a time, whose views are those of walls or eyes, wherever heads are.
    virtual bool has_own_views() const = 0;
    /// These views, as the heads are expected to be at a time.
    /// @param world_from_camera  the camera that the first user's head rests at; only its turn about the vertical
    /// counts @param steady_s  std::chrono::steady_clock
    virtual std::vector<ViewCommand> own_views(gi::dmat4 const& world_from_camera, double steady_s) = 0;
};

} // namespace viewer
