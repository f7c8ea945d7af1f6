#pragma once
#include <cstddef>
#include <span>

namespace gi {

/// width * height as the header of a PNG or JPEG says, before a decoder makes room for that; 0 = not known.
std::size_t claimed_pixels(std::span<unsigned char const> bytes);

} // namespace gi
