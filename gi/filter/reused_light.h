#pragma once
// Light that a picture takes from another picture of the same moment, because the two eyes see nearly the same.

#include "gi/image_io/picture.h"

#include <cstdint>
#include <span>

namespace gi {

/// Source pixel of a pixel that computed its own light instead of taking the partner's.
inline constexpr std::uint32_t kOwnLight = 0xffffffff;

struct ReusedLight {
    /// Partner image at the same processing stage; null if none.
    Picture const* partner = nullptr;
    /// Source pixel per pixel: index in the partner, row by row, or kOwnLight.
    std::span<std::uint32_t const> from{};
};

} // namespace gi
