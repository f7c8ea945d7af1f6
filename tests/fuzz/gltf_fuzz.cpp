// Any bytes as glTF: a scene or an InputError, never anything else.

#include "gi/core/error.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/world.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    gi::Report report;
    try {
        auto const scene = std::make_shared<gi::Scene const>(gi::parse_gltf(data, size, {}, "fuzz", report));
        gi::build_world(scene, 0.3, report);
    } catch (gi::InputError const&) {
    }
    return 0;
}
