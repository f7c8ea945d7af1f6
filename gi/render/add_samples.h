#pragma once
// Adds samples of paths to the means of pixels, on CPU and CUDA.

#include "gi/core/rng.h"
#include "gi/core/view.h"
#include "gi/render/accumulator.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace gi {
namespace means_detail {

/// Rounds numbers to single precision by chance, up or down, so that the error has mean 0: sums over many paths of
/// small contributions keep them (Croci et al. 2022, "Stochastic rounding"). What is representable stays
/// as it is. The chance is a hash of the path's number and first surface, so that the same paths give the same
/// bits, in each layer whatever the others hold.
class UnbiasedRounding {
public:
    GI_FN UnbiasedRounding(PathSample const& s, std::uint32_t paths)
        : state_(mix_bits(std::uint64_t(paths) << 32 ^ std::bit_cast<std::uint32_t>(s.position.x)))
    {
    }
    GI_FN float operator()(double value)
    {
        constexpr std::uint64_t kBeyondSingle = (std::uint64_t(1) << 29) - 1; // bits of a double's significand
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        std::uint64_t const bits = std::bit_cast<std::uint64_t>(value) + (state_ >> 35);
        return float(std::bit_cast<double>(bits & ~kBeyondSingle));
    }

private:
    std::uint64_t state_;
};

GI_FN inline void move_to(vec3& mean, vec3 value, float weight) { mean += (value - mean) * weight; }

GI_FN inline dvec3 sum(std::array<vec3, 3> const& of) { return dvec3(of[0]) + dvec3(of[1]) + dvec3(of[2]); }

/// At most the greatest number of single precision.
GI_FN inline double root(double squares)
{
    constexpr double kMost = double(std::numeric_limits<float>::max());
    double const r = std::sqrt(squares);
    return kMost < r ? kMost : r;
}

} // namespace means_detail

/// See PixelMeans::add. @param paths  number of paths, with this one
GI_FN inline void add_path(PixelMeans& m, PathSample const& s, std::uint32_t paths)
{
    using namespace means_detail;
    UnbiasedRounding round(s, paths);
    double const weight = 1 / double(paths);
    dvec3 const of_path = sum(s.radiance), before = sum(m.radiance);
#pragma unroll
    for (std::size_t i = 0; i < 3; ++i)
#pragma unroll
        for (int c = 0; c < 3; ++c) {
            double const mean = double(m.radiance[i][c]);
            m.radiance[i][c] = round(mean + (double(s.radiance[i][c]) - mean) * weight);
        }
    dvec3 const after = sum(m.radiance), d(m.deviation);
#pragma unroll
    for (int c = 0; c < 3; ++c)
        m.deviation[c] =
            round(root(d[c] * d[c] + glm::max(0.0, (of_path[c] - before[c]) * (of_path[c] - after[c]))));
    if (!s.hit) return;
    float const of_hits = 1 / float(++m.hits);
    move_to(m.albedo, s.albedo, of_hits);
    move_to(m.normal, s.normal, of_hits);
    move_to(m.position, s.position, of_hits);
    m.depth += (s.depth - m.depth) * of_hits;
}

/// Adds samples to the means of pixels.
struct AddToMeans {
    View<PixelMeans> means; ///< not read if there are no paths before
    std::uint32_t before;   ///< paths in the means

    /// @param path  number after those before
    GI_FN void add(std::size_t pixel, std::uint32_t path, PathSample const& s) const
    {
        PixelMeans m = before + path > 0 ? means[pixel] : PixelMeans{};
        add_path(m, s, before + path + 1);
        means[pixel] = m;
    }
};

/// Item = pixel. Adds a path.
struct AddSamples {
    View<PathSample const> samples;
    AddToMeans to;

    GI_FN void operator()(std::size_t i) const { to.add(i, 0, samples[i]); }
};

} // namespace gi
