#pragma once
#include "viewer/gl/swap_timer.h"
#include "viewer/gl/window.h"
#include "viewer/show/presenter.h"

namespace viewer {

/// A window with what it shows.
struct ShownWindow {
    Window window;
    Presenter presenter;
    SwapTimer timer;
    std::vector<Pane> panes, taken_panes; ///< now, and of the frame that was uploaded
    glm::ivec2 shown_px{};

    ShownWindow(WindowSettings const& settings, std::vector<WallSettings> const& walls, gi::Report& report)
        : window(settings, report), presenter(window, walls), timer(window, report)
    {
    }
};

} // namespace viewer
