// Any text as an AR session or as a file of albedos: what it says, or an InputError.

#include "ar/scene/albedo_file.h"
#include "ar/scene/session_file.h"
#include "gi/core/error.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const text(data, data + size);
    try {
        ar::Session const s = ar::parse_session(text, "fuzz");
        if (s.camera.empty() || s.markers.empty()) __builtin_trap();
    } catch (gi::InputError const&) {
    }
    try {
        auto const albedos = ar::parse_albedos(text, "fuzz");
        if (ar::parse_albedos(ar::format_albedos(albedos), "again").size() != albedos.size()) __builtin_trap();
    } catch (gi::InputError const&) {
    }
    return 0;
}
