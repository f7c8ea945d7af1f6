// Any text as a display, ours or another program's (the first byte says whose): a sound display or an InputError,
// never anything else. What is sound has views, and comes back as it was.

#include "gi/core/error.h"
#include "viewer/displays/calibration.h"
#include "viewer/displays/display_file.h"
#include "viewer/displays/import.h"
#include "viewer/displays/mesh_file.h"
#include "viewer/displays/view_summary.h"

#include <algorithm>
#include <cstdlib>

namespace {

/// Any text as a mesh of another program: one that can be drawn, or an InputError.
void read_meshes(std::string const& text)
{
    for (char const* name : {"fuzz.data", "fuzz.obj", "fuzz.csv"}) try {
            if (viewer::find_fault(viewer::parse_mesh_file(text, name, 1.5))) std::abort();
        } catch (gi::InputError const&) {
        }
}

viewer::Display parse(char kind, std::string const& text, gi::Report& report)
{
    switch (kind) {
    case 'p':
        return viewer::parse_pvx(text, "fuzz", report);
    case 's':
        return viewer::parse_sgct(text, "fuzz", report);
    case 'e':
        return viewer::parse_equalizer(text, "fuzz", report);
    case 'x':
        return viewer::parse_sgct_xml(text, "fuzz", report);
    case 'n':
        return viewer::parse_ndisplay(text, "fuzz", report);
    case 'c':
        return viewer::parse_ndisplay_cfg(text, "fuzz", report);
    case 'v':
        return viewer::parse_vrui(text, "fuzz", "", report);
    case 'i': {
        viewer::ImportLog const log(report);
        auto const none = viewer::CalibrationFiles::of_folder("/nonexistent");
        return viewer::display_of(viewer::read_mpcdi(text, "fuzz", none, log), "fuzz", log);
    }
    case 'w': {
        viewer::ImportLog const log(report);
        std::vector<unsigned char> const bytes(text.begin(), text.end());
        return viewer::display_of(viewer::read_vioso(bytes, "fuzz", 0.001, log), "fuzz", log);
    }
    case 'b': { // a configuration and its patch, with a form feed between them
        std::size_t const half = std::min(text.find('\f'), text.size());
        return viewer::parse_vrui(
            {{text.substr(0, half), "base"}, {text.substr(std::min(half + 1, text.size())), "fuzz"}}, "", report);
    }
    default:
        return viewer::parse_display(text, "fuzz", report);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    if (size < 2) return 0;
    gi::Report report;
    std::string const text(reinterpret_cast<char const*>(data) + 1, size - 1);
    if (data[0] == 'm') {
        read_meshes(text);
        return 0;
    }
    if (data[0] == 'f') {
        try {
            viewer::parse_points({data + 1, size - 1}, 0.001, "fuzz");
        } catch (gi::InputError const&) {
        }
        return 0;
    }
    viewer::Display display;
    try {
        display = parse(char(data[0]), text, report);
    } catch (gi::InputError const&) {
        return 0;
    }
    viewer::summarise_views(display);
    bool const is_ascii = std::all_of(text.begin(), text.end(), [](char c) { return c > 0 && c < 127; });
    bool const has_files = std::any_of(display.walls.begin(), display.walls.end(),
                                       [](viewer::Wall const& wall) { return !files_of(wall).empty(); });
    if (is_ascii && !has_files && viewer::parse_display(viewer::to_yaml(display), "again", report) != display)
        std::abort();
    return 0;
}
