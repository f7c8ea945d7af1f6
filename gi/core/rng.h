#pragma once
// Independent pseudo-random streams: PCG32 (O'Neill 2014, XSH-RR 64/32), keyed by (seed, pixel, path) so
// that a picture does not depend on which thread computed it.

#include "gi/core/math.h"

#include <cstdint>

namespace gi {

/// 64-bit finaliser of SplitMix64 (Steele et al. 2014): a bijection with full avalanche.
GI_FN inline std::uint64_t mix_bits(std::uint64_t v)
{
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ULL;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebULL;
    return v ^ (v >> 31);
}

class Pcg32 {
public:
    GI_FN Pcg32(std::uint64_t state, std::uint64_t stream) : state_(0), increment_((stream << 1) | 1)
    {
        next();
        state_ += state;
        next();
    }
    /// Returns the random stream of one path of one pixel.
    GI_FN static Pcg32 for_path(std::uint64_t seed, std::uint32_t pixel, std::uint32_t path)
    {
        std::uint64_t const key = (std::uint64_t(pixel) << 32) | path;
        std::uint64_t const hashed = mix_bits(key + mix_bits(seed + 0x9e3779b97f4a7c15ULL));
        return {hashed, mix_bits(hashed + 0x9e3779b97f4a7c15ULL)};
    }
    GI_FN std::uint32_t next()
    {
        std::uint64_t const old = state_;
        state_ = old * 6364136223846793005ULL + increment_;
        auto const shifted = std::uint32_t(((old >> 18) ^ old) >> 27);
        auto const rotation = std::uint32_t(old >> 59);
        return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
    }
    /// Uniform in [0, 1), a multiple of 2^-24.
    GI_FN float uniform() { return float(next() >> 8) * 0x1p-24f; }
    /// Uniform in [0, 1), a multiple of 2^-53.
    GI_FN double uniform_double()
    {
        std::uint64_t const high = next() >> 6;
        return double((high << 27) | (next() >> 5)) * 0x1p-53;
    }
    GI_FN vec2 uniform2()
    {
        float const x = uniform();
        return {x, uniform()};
    }

private:
    std::uint64_t state_, increment_;
};

} // namespace gi
