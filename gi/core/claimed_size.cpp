#include "gi/core/claimed_size.h"

#include <cstring>

namespace gi {
namespace {

std::size_t big_endian(std::span<unsigned char const> bytes)
{
    std::size_t v = 0;
    for (unsigned char const b : bytes) v = v << 8 | b;
    return v;
}

} // namespace

std::size_t claimed_pixels(std::span<unsigned char const> bytes)
{
    if (bytes.size() >= 24 && std::memcmp(bytes.data(), "\x89PNG", 4) == 0)
        return big_endian(bytes.subspan(16, 4)) * big_endian(bytes.subspan(20, 4));
    if (bytes.size() < 4 || bytes[0] != 0xff || bytes[1] != 0xd8) return 0;
    for (std::size_t at = 2; at + 9 <= bytes.size() && bytes[at] == 0xff;) { // the segments of a JPEG
        unsigned const marker = bytes[at + 1];
        bool const start_of_frame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (start_of_frame) return big_endian(bytes.subspan(at + 5, 2)) * big_endian(bytes.subspan(at + 7, 2));
        at += marker == 0xff ? 1 : 2 + big_endian(bytes.subspan(at + 2, 2));
    }
    return 0;
}

} // namespace gi
