#pragma once
// Operations that kernels write differently for the CPU and for a device.

#include "gi/core/platform.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace gi {

#if defined(__CUDA_ARCH__)
inline constexpr bool kDeviceCode = true;
#else
inline constexpr bool kDeviceCode = false;
#endif

/// Four words that a device loads at once.
struct FourWords {
    std::uint32_t word[4];
};

/// @param from  aligned to 16 bytes; not written while the kernel runs
GI_FN inline FourWords load_words(void const* from, std::size_t index)
{
#if defined(__CUDA_ARCH__)
    uint4 const v = __ldg(static_cast<uint4 const*>(from) + index);
    return {{v.x, v.y, v.z, v.w}};
#else
    FourWords w;
    std::memcpy(&w, static_cast<char const*>(from) + index * sizeof(w), sizeof(w));
    return w;
#endif
}

/// a < b ? b : a, by one instruction of a device; NaN is ignored there.
GI_FN inline float larger(float a, float b)
{
#if defined(__CUDA_ARCH__)
    return fmaxf(a, b);
#else
    return a < b ? b : a;
#endif
}
GI_FN inline float smaller(float a, float b)
{
#if defined(__CUDA_ARCH__)
    return fminf(a, b);
#else
    return b < a ? b : a;
#endif
}

/// Index of the lowest bit that is set. @param bits  not 0
GI_FN inline std::uint32_t lowest_bit(std::uint32_t bits)
{
#if defined(__CUDA_ARCH__)
    return std::uint32_t(__ffs(int(bits)) - 1);
#else
    return std::uint32_t(std::countr_zero(bits));
#endif
}

} // namespace gi
