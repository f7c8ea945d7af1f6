#pragma once
// Where an experiment is shown: its window or display, and the calibration of the monitor.

#include "viewer/devices/gl/window.h"
#include "viewer/displays/display.h"
#include "viewer/experiment/screens/screen.h"

#include <optional>

namespace viewer {

struct ScreenSettings {
    WindowSettings window;
    float font_px = 22;
    std::optional<study::DisplayModel> model; ///< of the window's monitor
    std::optional<Display> display; ///< used instead of the window; text and patch are in its first window
};

} // namespace viewer
