// Any text as a scene file: a scene or an InputError, never anything else.

#include "gi/core/error.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/world.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    gi::Report report;
    try {
        std::string const text(reinterpret_cast<char const*>(data), size);
        gi::build_world(std::make_shared<gi::Scene const>(gi::parse_scene_file(text, {}, "fuzz", report)), 0.3,
                        report);
    } catch (gi::InputError const&) {
    }
    return 0;
}
