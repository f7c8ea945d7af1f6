#pragma once
#include <cstddef>
#include <span>

namespace gi {

/// width * height stated in a PNG or JPEG header, to be checked before a decoder allocates memory; 0 = unknown.
std::size_t claimed_pixels(std::span<unsigned char const> bytes);

} // namespace gi
