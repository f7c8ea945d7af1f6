#pragma once
// Randomised quasi-Monte Carlo: the van der Corput sequence with an Owen scramble of its own for every stream and
// dimension (Owen 1995; hashed as in Burley 2020, "Practical Hash-based Owen Scrambling", with Vegdahl's constants).
// Any run of 2^k consecutive indices that starts at a multiple of 2^k is stratified in each dimension; scrambles are
// independent, so that no two dimensions and no two bounces are paired.

#include "gi/base/rng.h"

namespace gi {

GI_FN inline std::uint32_t reverse_bits(std::uint32_t v)
{
    v = (v >> 16) | (v << 16);
    v = ((v & 0x00ff00ffu) << 8) | ((v >> 8) & 0x00ff00ffu);
    v = ((v & 0x0f0f0f0fu) << 4) | ((v >> 4) & 0x0f0f0f0fu);
    v = ((v & 0x33333333u) << 2) | ((v >> 2) & 0x33333333u);
    return ((v & 0x55555555u) << 1) | ((v >> 1) & 0x55555555u);
}

/// A permutation of 32-bit words in which every bit depends on lower bits only.
GI_FN inline std::uint32_t permute_upwards(std::uint32_t v, std::uint32_t seed)
{
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

struct RqmcStream {
    std::uint32_t seed = 0;  ///< of the pixel, say
    std::uint32_t index = 0; ///< of the path

    /// Uniform in [0, 1), a multiple of 2^-24.
    GI_FN float sample(std::uint32_t dimension) const
    {
        std::uint64_t const key = mix_bits((std::uint64_t(seed) << 32) | dimension);
        std::uint32_t const word = permute_upwards(index, std::uint32_t(key)) ;
        return float(reverse_bits(word) >> 8) * 0x1p-24f;
    }
    GI_FN vec2 sample2(std::uint32_t dimension) const { return {sample(dimension), sample(dimension + 1)}; }
};

} // namespace gi
