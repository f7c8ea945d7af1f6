// Any text as a scene file: a scene or an InputError, never anything else.

#include "gi/base/error.h"
#include "gi/scene/load.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    gi::Report report;
    try {
        gi::parse_scene_file(std::string(reinterpret_cast<char const*>(data), size), {}, "fuzz", report);
    } catch (gi::InputError const&) {
    }
    return 0;
}
