#include "viewer/displays/import.h"

#include "gi/core/file.h"
#include "viewer/displays/check.h"
#include "viewer/displays/display_file.h"
#include "viewer/displays/import_common.h"

#include <fmt/format.h>

namespace viewer {

char const* name_of(DisplayFormat format)
{
    switch (format) {
    case DisplayFormat::sgct:
        return "SGCT";
    case DisplayFormat::pvx:
        return "ParaView";
    case DisplayFormat::equalizer:
        return "Equalizer";
    case DisplayFormat::vrui:
        return "Vrui";
    case DisplayFormat::yaml:
        break;
    }
    return "Lightwell";
}

DisplayFormat format_of(std::filesystem::path const& file)
{
    std::string const end = file.extension().string();
    for (auto const& [known, format] : {std::pair{".yaml", DisplayFormat::yaml},
                                        {".yml", DisplayFormat::yaml},
                                        {".json", DisplayFormat::sgct},
                                        {".pvx", DisplayFormat::pvx},
                                        {".eqc", DisplayFormat::equalizer},
                                        {".cfg", DisplayFormat::vrui}})
        if (end == known) return format;
    throw gi::InputError("'" + file.string() + "' is of no known kind of display", "its file extension is unknown",
                         ".yaml (ours), .json (SGCT), .pvx (ParaView), .eqc (Equalizer), .cfg (Vrui)");
}

Display import_display(std::filesystem::path const& file, std::string const& section, gi::Report& report)
{
    DisplayFormat const format = format_of(file);
    if (!section.empty() && format != DisplayFormat::vrui)
        throw gi::InputError("a section of " + file.string(), "only configurations of Vrui have sections",
                             "leave it out");
    auto const bytes = gi::read_bytes(file, std::size_t(1) << 20);
    std::string const text(bytes.begin(), bytes.end()), name = file.string();
    switch (format) {
    case DisplayFormat::sgct:
        return parse_sgct(text, name, report);
    case DisplayFormat::pvx:
        return parse_pvx(text, name, report);
    case DisplayFormat::equalizer:
        return parse_equalizer(text, name, report);
    case DisplayFormat::vrui:
        return parse_vrui(text, name, section, report);
    case DisplayFormat::yaml:
        break;
    }
    return parse_display(text, name, report);
}

double imported_eyes(double metres, std::string const& where, gi::Report& report)
{
    if (metres >= kNarrowestEyes_m && metres <= kWidestEyes_m) return metres;
    report.lose("implausible interpupillary distances, replaced by 0.063 m", 1,
                fmt::format("{}: {} m", where, metres));
    return User{}.interpupillary_m;
}

Viewport from_below(double x, double y, double width, double height)
{
    return {LengthUnit::fraction, x, 1 - y - height, width, height};
}

Display finished(Display display, std::string const& file, gi::Report& report)
{
    if (display.walls.empty())
        throw gi::InputError({file, 0, 0}, "no wall could be imported", "there is nothing to draw on",
                             "flat walls with corners are needed; see what was skipped");
    // Fractions written with few digits may miss the window's edge by less than a pixel.
    for (Wall& wall : display.walls)
        if (Viewport& v = wall.viewport; v.unit == LengthUnit::fraction) {
            auto const tidy = [](double& at, double& size) {
                if (std::abs(at) < 1e-3) at = 0;
                if (std::abs(at + size - 1) < 1e-3) size = 1 - at;
            };
            tidy(v.x, v.width);
            tidy(v.y, v.height);
        }
    require_sound(display, file);
    report_doubts(display, report);
    return display;
}

} // namespace viewer
