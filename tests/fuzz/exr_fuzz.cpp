// Any bytes as OpenEXR: a picture or an InputError, never anything else.

#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    try {
        gi::decode_exr({data, size}, "fuzz");
    } catch (gi::InputError const&) {
    }
    return 0;
}
