// Any text as a map of markers: a map that comes back as it was, or an InputError.

#include "ar/markers/marker_map_file.h"
#include "gi/core/error.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const text(data, data + size);
    try {
        ar::MarkerMap const map = ar::parse_marker_map(text, "fuzz");
        if (!(ar::parse_marker_map(ar::format_marker_map(map), "again") == map)) __builtin_trap();
        if (ar::placed_markers(map).empty()) __builtin_trap();
        for (int i = 0; i < ar::count_of(map); ++i)
            if (ar::describe(map, i).empty()) __builtin_trap();
    } catch (gi::InputError const&) {
    }
    return 0;
}
