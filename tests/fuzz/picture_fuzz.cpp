// Any bytes as a frame's picture: pixels of the format that it names, or a problem; never an exception.

#include "ar/capture/decode_picture.h"

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    ar::DecodedPicture const p = ar::decoded_picture({data, size});
    if (!p.problem.empty()) return 0;
    bool const fits = p.format == ar::PixelFormat::bgr8         ? p.pixels.type() == CV_8UC3
                      : p.format == ar::PixelFormat::gray8      ? p.pixels.type() == CV_8UC1
                      : p.format == ar::PixelFormat::rgb16      ? p.pixels.type() == CV_16UC3
                      : p.format == ar::PixelFormat::rgb_linear ? p.pixels.type() == CV_32FC3
                                                                : false;
    if (!fits || p.pixels.empty()) __builtin_trap();
    return 0;
}
