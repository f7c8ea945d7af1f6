// Any text as a table of measurements or as statistics of a render: what it says, or an InputError.
// A table comes back as it was.

#include "gi/core/error.h"
#include "viewer/report/render_stats.h"
#include "viewer/report/table_file.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const text(reinterpret_cast<char const*>(data), size);
    try {
        std::string const once = viewer::to_json(viewer::parse_table(text, "fuzz"));
        if (viewer::to_json(viewer::parse_table(once, "again")) != once) std::abort();
    } catch (gi::InputError const&) {
    }
    try {
        if (viewer::is_render_stats(text)) viewer::parse_render_stats(text, "fuzz");
    } catch (gi::InputError const&) {
    }
    return 0;
}
