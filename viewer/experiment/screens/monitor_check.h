#pragma once
// The monitor that a window is on, and whether a display model was measured on it.

#include "gi/core/report.h"
#include "study/display/display_model.h"
#include "viewer/devices/gl/window.h"

namespace viewer {

/// The monitor under the window's centre; the first one if none is there. None without monitors.
std::optional<MonitorInfo> monitor_of(Window const& window);
/// "DP-1, 1920 x 1080 px, 60 Hz"
std::string to_text(MonitorInfo const& monitor);

/// Throws InputError if the model's pixels are not those of the monitor's mode, because degrees and centimetres
/// would be wrong. Another name or refresh rate is counted in the report.
void check_monitor(study::DisplayModel const& model, std::optional<MonitorInfo> const& monitor,
                   gi::Report& report);

} // namespace viewer
