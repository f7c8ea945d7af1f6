#pragma once
#include "viewer/app/shown_window.h"
#include "viewer/displays/display.h"

#include <memory>

namespace viewer {

/// The windows of a display that this process shows.
struct DisplayWindows {
    std::vector<std::unique_ptr<ShownWindow>> windows;
    std::vector<int> of; ///< per window of the display: index into windows; -1 = another process's
};

/// Opens them. Walls whose window has no quad buffers are set side by side. Throws InputError.
/// @param rank  as of windows_of; -1 = all
DisplayWindows open_windows(Display& display, int rank, int swap_interval, gi::Report& report);
/// The windows' sizes as they are, which may not be what the file wishes.
void note_sizes(Display& display, DisplayWindows const& shown);

} // namespace viewer
