#pragma once
// Light that a picture takes from another one of the same moment, as the two eyes of a person see nearly the same.

#include "gi/image_io/picture.h"

#include <cstdint>
#include <span>

namespace gi {

/// Where a pixel takes its light from: a pixel of the partner's picture, else this.
inline constexpr std::uint32_t kOwnLight = 0xffffffff;

struct ReusedLight {
    /// As far on its way as the picture that takes is to be brought; null = none.
    Picture const* partner = nullptr;
    std::span<std::uint32_t const> from{}; ///< per pixel: a pixel of the partner, row by row, or kOwnLight
};

} // namespace gi
