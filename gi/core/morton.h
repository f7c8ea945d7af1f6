#pragma once
// Morton curve: the cells of an octree in order.

#include "gi/core/math.h"

#include <cstdint>

namespace gi {

/// Interleaves the bits of three coordinates, of 21 bits each; x has the lowest.
GI_FN inline std::uint64_t morton(std::uint32_t x, std::uint32_t y, std::uint32_t z)
{
    auto const spread = [](std::uint64_t v) {
        v = (v | v << 32) & 0x1f00000000ffffull;
        v = (v | v << 16) & 0x1f0000ff0000ffull;
        v = (v | v << 8) & 0x100f00f00f00f00full;
        v = (v | v << 4) & 0x10c30c30c30c30c3ull;
        return (v | v << 2) & 0x1249249249249249ull;
    };
    return spread(x) | spread(y) << 1 | spread(z) << 2;
}

} // namespace gi
