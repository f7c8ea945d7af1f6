#pragma once
// One entry of a hit buffer: a surface under a texel centre.

#include "gi/core/platform.h"

#include <cstdint>

namespace gi {

struct HitLayer {
    float depth;             ///< along the axis, m
    std::uint32_t primitive; ///< triangle of the world, with bit kAlongAxis
};

/// Sort order of the layers of a texel.
GI_FN inline bool before(HitLayer const& a, HitLayer const& b)
{
    return a.depth < b.depth || (a.depth == b.depth && a.primitive < b.primitive);
}

} // namespace gi
