#pragma once
// Aliases for Highway's SIMD vectors at the width of LIGHTWELL_MARCH; for .cpp files only.

#include <hwy/highway.h>

namespace gi::lanes {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Words = hn::RebindToUnsigned<Floats>;
using Integers = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using I = hn::Vec<Integers>;
using W = hn::Vec<Words>;
using Mask = hn::Mask<Floats>;
inline constexpr std::size_t kMostLanes = HWY_MAX_BYTES / sizeof(float);

/// Returns the mask with one bit per lane.
inline std::uint32_t bits_of(Mask mask)
{
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Floats(), mask, bytes);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < (kMostLanes + 7) / 8; ++k) bits |= std::uint32_t(bytes[k]) << (8 * k);
    return bits;
}

} // namespace gi::lanes
