#pragma once
// Import of display files from other programs. Settings without an equivalent here, and values that had to be
// assumed, are counted in the report by name; nothing is dropped silently.
//
// Corners, frame and units of each format:
// - SGCT, JSON: lowerleft, upperleft, upperright; our frame, m.
// - ParaView .pvx: LowerLeft, LowerRight, UpperRight (or UpperLeft); our frame, taken as m.
// - Equalizer .eqc: bottom_left, bottom_right, top_left; our frame, m.
// - Vrui .cfg: origin, horizontalAxis, verticalAxis, width, height; forwardDirection becomes -Z, upDirection +Y;
//   inchScale or meterScale.
//
// Viewports of SGCT and Equalizer count from the window's lower left corner, ours from the top left corner.

#include "gi/core/report.h"
#include "viewer/displays/display.h"

#include <filesystem>
#include <string>

namespace viewer {

enum class DisplayFormat { yaml, sgct, pvx, equalizer, vrui };
char const* name_of(DisplayFormat format);
/// Format by file extension: .yaml or .yml, .json, .pvx, .eqc, .cfg. Throws InputError for others.
DisplayFormat format_of(std::filesystem::path const& file);

/// Each throws InputError, with file:line:column if known, if the text is not of the format or the display is
/// invalid.
Display parse_sgct(std::string const& text, std::string const& name, gi::Report& report);
Display parse_pvx(std::string const& text, std::string const& name, gi::Report& report);
Display parse_equalizer(std::string const& text, std::string const& name, gi::Report& report);
/// `section` names the environment within "section Vrui"; empty = the first with screens.
Display parse_vrui(std::string const& text, std::string const& name, std::string const& section,
                   gi::Report& report);
/// Imports any format, including ours, by file extension. `section` is for Vrui.
Display import_display(std::filesystem::path const& file, std::string const& section, gi::Report& report);

} // namespace viewer
