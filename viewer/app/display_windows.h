#pragma once
// Opens the windows of a display file.

#include "viewer/app/shown_window.h"
#include "viewer/displays/display.h"

#include <functional>
#include <memory>

namespace viewer {

/// Windows of a display that this process shows.
struct DisplayWindows {
    std::vector<std::unique_ptr<ShownWindow>> windows;
    std::vector<int> of; ///< per window of the display: index into windows; -1 = shown by another process
};

/// Opens the windows. Falls back to side by side for walls whose window lacks quad buffers. Throws InputError.
/// @param rank  as in windows_of; -1 = all
/// @param opened  called for each window before the next is opened; may be empty
DisplayWindows open_windows(Display& display, int rank, int swap_interval, gi::Report& report,
                            std::function<void(ShownWindow&)> const& opened = {});
/// Sets the actual sizes of the windows, which may differ from those in the file.
void note_sizes(Display& display, DisplayWindows const& shown);

} // namespace viewer
