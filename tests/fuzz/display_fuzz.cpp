// Any text as a display, ours or another program's (the first byte says whose): a sound display or an InputError,
// never anything else. What is sound has views, and comes back as it was.

#include "gi/core/error.h"
#include "viewer/displays/display_file.h"
#include "viewer/displays/import.h"
#include "viewer/displays/view_summary.h"

#include <algorithm>
#include <cstdlib>

namespace {

viewer::Display parse(char kind, std::string const& text, gi::Report& report)
{
    switch (kind) {
    case 'p':
        return viewer::parse_pvx(text, "fuzz", report);
    case 's':
        return viewer::parse_sgct(text, "fuzz", report);
    case 'e':
        return viewer::parse_equalizer(text, "fuzz", report);
    case 'v':
        return viewer::parse_vrui(text, "fuzz", "", report);
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
    viewer::Display display;
    try {
        display = parse(char(data[0]), text, report);
    } catch (gi::InputError const&) {
        return 0;
    }
    viewer::summarise_views(display);
    bool const is_ascii = std::all_of(text.begin(), text.end(), [](char c) { return c > 0 && c < 127; });
    bool const has_files = std::any_of(display.walls.begin(), display.walls.end(),
                                       [](viewer::Wall const& wall) { return !wall.warp_file.empty(); });
    if (is_ascii && !has_files && viewer::parse_display(viewer::to_yaml(display), "again", report) != display)
        std::abort();
    return 0;
}
