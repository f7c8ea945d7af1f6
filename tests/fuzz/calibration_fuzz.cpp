// Any text as a calibration: one whose camera has rays for half of its picture and that comes back as it was, or an
// InputError.

#include "ar/calibration/calibration_file.h"
#include "ar/camera/lens_domain.h"
#include "gi/core/error.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const text(data, data + size);
    try {
        ar::Calibration const c = ar::parse_calibration(text, "fuzz", glm::ivec2(640, 480));
        if (!(ar::reach_of(c.camera).share >= 0.5)) __builtin_trap();
        std::string const once = ar::format_calibration(c);
        ar::Calibration plain = c;
        plain.provenance.clear(); // keys of others' files may be anything
        ar::Calibration const again = ar::parse_calibration(ar::format_calibration(plain), "again");
        if (!(again.camera == c.camera) || again.photometry.has_value() != c.photometry.has_value())
            __builtin_trap();
    } catch (gi::InputError const&) {
    }
    return 0;
}
