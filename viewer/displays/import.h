#pragma once
// Displays that other programs describe. What they say and we do not is counted in the report by its name, and so
// is what had to be assumed; nothing is dropped in silence.
//
// | format                | corners                                          | frame, units |
// |-----------------------|--------------------------------------------------|---------------------------------------------|
// | SGCT, JSON            | lowerleft, upperleft, upperright                 | as ours, m | | ParaView .pvx |
// LowerLeft, LowerRight, UpperRight (or UpperLeft) | as ours, taken as m                         | | Equalizer
// .eqc        | bottom_left, bottom_right, top_left              | as ours, m                                  |
// | Vrui .cfg             | origin, horizontalAxis, verticalAxis, width, height | forwardDirection becomes -Z,
// upDirection +Y; inchScale or meterScale |
//
// Viewports of SGCT and Equalizer count from the lower left corner of the window; ours from the top left one.

#include "gi/core/report.h"
#include "viewer/displays/display.h"

#include <filesystem>
#include <string>

namespace viewer {

enum class DisplayFormat { yaml, sgct, pvx, equalizer, vrui };
char const* name_of(DisplayFormat format);
/// By the end of the file's name: .yaml or .yml, .json, .pvx, .eqc, .cfg. Throws InputError on others.
DisplayFormat format_of(std::filesystem::path const& file);

/// Each throws InputError with file:line:column where known, on what is not of the format and on what makes no
/// sound display.
Display parse_sgct(std::string const& text, std::string const& name, gi::Report& report);
Display parse_pvx(std::string const& text, std::string const& name, gi::Report& report);
Display parse_equalizer(std::string const& text, std::string const& name, gi::Report& report);
/// `section` names the environment within "section Vrui"; empty = the first that has screens.
Display parse_vrui(std::string const& text, std::string const& name, std::string const& section,
                   gi::Report& report);
/// Any of them, ours included, by the end of its name. `section` is for Vrui.
Display import_display(std::filesystem::path const& file, std::string const& section, gi::Report& report);

} // namespace viewer
