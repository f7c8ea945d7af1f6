#pragma once
// Randomised quasi-Monte Carlo: the van der Corput sequence with an independent Owen scramble for every stream and
// dimension (Owen 1995; hashed as in Burley 2020, "Practical Hash-based Owen Scrambling", with Vegdahl's
// constants). Any run of 2^k consecutive indices that starts at a multiple of 2^k is stratified in each dimension.
// Scrambles and index orders are independent, so no two dimensions and no two bounces are correlated.

#include "gi/core/rng.h"

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

/// 32-bit hash of two words (finaliser by Wellons 2018, "lowbias32").
GI_FN inline std::uint32_t hash_words(std::uint32_t a, std::uint32_t b)
{
    std::uint32_t h = a ^ (b * 0x9e3779b9u);
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

/// Direction numbers of the first four Sobol dimensions (Joe & Kuo 2008), by their recurrence.
struct SobolMatrices {
    std::uint32_t column[4][32];
};

constexpr SobolMatrices make_sobol()
{
    constexpr int degree[4] = {0, 1, 2, 3};
    constexpr std::uint32_t polynomial[4] = {0, 0, 1, 1},
                            first[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 3, 0}, {1, 3, 1}};
    SobolMatrices s{};
    for (int d = 0; d < 4; ++d)
        for (int k = 0; k < 32; ++k) {
            if (k < degree[d] || d == 0) {
                s.column[d][k] = (d == 0 ? 1u : first[d][k]) << (31 - k);
                continue;
            }
            std::uint32_t v = s.column[d][k - degree[d]];
            v ^= v >> degree[d];
            for (int j = 1; j < degree[d]; ++j)
                if ((polynomial[d] >> (degree[d] - 1 - j) & 1) != 0) v ^= s.column[d][k - j];
            s.column[d][k] = v;
        }
    return s;
}

inline constexpr SobolMatrices kSobol = make_sobol();

class RqmcStream {
public:
    RqmcStream() = default;
    GI_FN RqmcStream(std::uint32_t stream_seed, std::uint32_t path) : seed(stream_seed), index(path) {}

    std::uint32_t seed = 0;  ///< for example a hash of the pixel
    std::uint32_t index = 0; ///< number of the path
    /// 0 to 15: number of this stream among sixteen streams that share a seed. At any one index, the samples of
    /// the sixteen streams lie in sixteen different strata.
    std::uint32_t place = 0;

    /// Seed that differs between the sixteen streams.
    GI_FN std::uint32_t own_seed() const { return seed + 0x9e3779b9u * place; }
    /// Uniform in [0, 1), a multiple of 2^-24.
    GI_FN float sample(std::uint32_t dimension) const
    {
        std::uint32_t const key = hash_words(seed, dimension);
        std::uint32_t const at = shuffled(key) ^ shuffled_place(key), scramble = key * 0x2c1b3c6du + 0x297a2d39u;
        // The sixteen streams share the mapping from index to stratum; positions in the stratum are independent.
        std::uint32_t const stratum = permute_upwards(at, scramble) & 15,
                            within = permute_upwards(at, scramble + 0x9e3779b9u * place) & ~15u;
        std::uint32_t const word = stratum | within;
        return float(reverse_bits(word) >> 8) * 0x1p-24f;
    }
    GI_FN vec2 sample2(std::uint32_t dimension) const { return {sample(dimension), sample(dimension + 1)}; }
    /// Counter for round-robin choices: increases by one with the index, and differs between the sixteen streams.
    GI_FN std::uint32_t turn(std::uint32_t dimension) const
    {
        std::uint32_t const key = hash_words(seed, dimension);
        return (key >> 8) + shuffled_place(key) + index;
    }
    /// Two unstratified random numbers in [0, 1), for decisions that matter little.
    GI_FN vec2 noise2(std::uint32_t dimension) const
    {
        std::uint32_t const h = hash_words(own_seed() + 0x68bc21ebu * index, dimension);
        return {float(h >> 16) * 0x1p-16f, float(h & 0xffffu) * 0x1p-16f};
    }
    /// Four jointly stratified numbers (Sobol) for one decision. Host only.
    vec4 sample_together(std::uint32_t dimension) const
    {
        vec4 out{0};
        std::uint32_t const at = shuffled(hash_words(seed, dimension));
        for (std::uint32_t d = 0; d < 4; ++d) {
            std::uint32_t word = 0;
            for (int k = 0; k < 32; ++k)
                if ((at >> k & 1) != 0) word ^= kSobol.column[d][k];
            std::uint32_t const key = hash_words(~seed, dimension + d);
            out[glm::length_t(d)] = float(reverse_bits(permute_upwards(reverse_bits(word), key)) >> 8) * 0x1p-24f;
        }
        return out;
    }

private:
    /// `place` permuted differently for every dimension.
    GI_FN std::uint32_t shuffled_place(std::uint32_t key) const
    {
        std::uint32_t p = (place * (key | 1) + (key >> 4)) & 15;
        p ^= p >> 2;
        p = (p * (key >> 8 | 1) + (key >> 12)) & 15;
        p ^= p >> 2;
        return (p * (key >> 16 | 1) + (key >> 20)) & 15;
    }
    /// Index permuted differently for every dimension such that runs of 2^k stay together. Without this, the top
    /// bits of all dimensions would depend on the same bit of the index.
    GI_FN std::uint32_t shuffled(std::uint32_t key) const
    {
        return reverse_bits(permute_upwards(reverse_bits(index), key));
    }
};

} // namespace gi
