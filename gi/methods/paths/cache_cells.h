#pragma once
// The cells of the radiance cache as CPU and kernels see them: which cells contain a point, and what their sums tell.
// See radiance_cache.h.

#include "gi/core/rng.h"
#include "gi/scene/model/world.h"
#include "gi/scene/shading/narrow_lobes.h"

#include <array>
#include <bit>
#include <cmath>

namespace gi {

/// The cells that contain a point where a path can end: from the widest, each half as wide as the one before.
struct CacheKeys {
    static constexpr std::size_t kLevels = 4;
    std::array<std::uint64_t, kLevels> level{}; ///< 0 = none

    GI_FN bool any() const { return level[0] != 0; }
};

/// What paths have brought to a cell.
struct CellSums {
    vec3 radiance{0}; ///< sum of weight times radiance
    float weight = 0, notes = 0; ///< notes < 0: no path may end here
    float squares = 0; ///< sum of (weight times luminance)^2
};

/// Known outgoing radiance at a point.
struct CachedRadiance {
    vec3 radiance{0};
    float go_on = 1;          ///< probability that a path continues anyway, to teach; 1 = nothing known
    std::size_t to_teach = 1; ///< number of levels to teach, from the widest
};

namespace cache_detail {

/// Largest width of the widest level's cells relative to the footprint; rounding to powers of two can halve it.
/// This and the numbers below are measured: docs/decisions/radiance-cache.md.
inline constexpr float kWidth = 0.6f;
/// Number of notes required before paths end in a cell; with more, the probability of continuing falls inversely.
inline constexpr float kEnough = 3;
/// Lower limit of that probability: kTeaching times the relative deviation of the widest cell's notes, clamped to the
/// other two, because all pixels share a cell's error and no filter removes it. In a mean over reading and
/// teaching paths, teaching pays off in this proportion.
inline constexpr float kTeaching = 0.05f, kLeastTeaching = 0.03f, kMostTeaching = 0.3f;
/// Number of notes from which on cells of half the width are also taught.
inline constexpr float kSplit = 64;
/// The estimate of the wider cell has the weight of this many notes.
inline constexpr float kPrior = 8;
/// After this many passes, paths no longer end in the widest cells;
/// after kSlower times as many, nor in the next ones.
inline constexpr std::uint32_t kPassesOfWidest = 16, kSlower = 8;
/// Cells are separate by the number of scatterings that may follow; larger numbers than this share cells.
inline constexpr int kMostFurther = 16;

/// Index of the side of a cube through which a normal points.
GI_FN inline std::uint64_t side_of(vec3 n)
{
    vec3 const a = glm::abs(n);
    int const axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return std::uint64_t(2 * axis + (n[axis] < 0 ? 1 : 0));
}

/// Relative standard deviation of weight times luminance.
GI_FN inline float deviation(CellSums const& c)
{
    float const mean = luminance(c.radiance) / c.notes;
    float const squared = mean > 0 ? c.squares / (c.notes * mean * mean) - 1 : 0;
    return squared < kInf ? std::sqrt(glm::max(0.0f, squared)) : 0;
}

} // namespace cache_detail

/// Offset of all cells, m, so that axis-aligned walls do not coincide with cell borders. @param radius  of the world, m
GI_FN inline vec3 cell_shift(float radius) { return 1e-3f * radius * vec3{0.819f, 0.671f, 0.550f}; }

/// The widest level in whose cells paths may end. @param passes  that have ended
GI_FN inline std::size_t least_level(std::uint32_t passes)
{
    using namespace cache_detail;
    std::size_t level = 0;
    for (std::uint32_t most = kPassesOfWidest; passes >= most && level + 1 < CacheKeys::kLevels; most *= kSlower)
        ++level;
    return level;
}

/// In the first pass paths teach an empty cache in turns, as later ones of them end where earlier ones have taught: of
/// sixteen blocks of pixels, 1, 1, 2, 4 and 8 have turns 0 to 4.
inline constexpr std::uint32_t kCacheTurns = 5;
inline std::uint32_t turn_of(std::size_t block) { return std::uint32_t(std::bit_width((block * 7) & 15)); }
/// Pixels of a block, with exact rays.
inline constexpr std::size_t kPixelsOfTurn = 256;

/// True if outgoing light depends so much on direction that paths cannot share it: mirrors, glass, and narrow
/// lobes except the weak one of a coat.
GI_FN inline bool is_directional(Bsdf const& b)
{
    constexpr float kWeak = 0.1f;
    if (b.clear > 0 || (b.f90.x > 0 && b.alpha < kSmoothAlpha)) return true;
    return has_narrow_lobe(b) && max_component(b.model == MaterialModel::phong ? b.phong_specular : b.f0) > kWeak;
}

/// Returns equal keys for points on the same material and the same side of triangles, with similar orientation, in the
/// same cell. Empty if floats are too coarse for cells this narrow.
/// @param shift  see cell_shift  @param footprint  width of the bundle that the path represents, m
/// @param arrival  direction of the path  @param further  number of scatterings that may follow, >= 0
GI_FN inline CacheKeys cell_keys(Surface const& surface, vec3 shift, vec3 position, vec3 arrival, float footprint,
                                 int further)
{
    using namespace cache_detail;
    CacheKeys keys;
    if (!(footprint > 0) || !(footprint < kInf)) return keys;
    constexpr int kFinest = int(CacheKeys::kLevels) - 1;
    int const widest = std::ilogb(kWidth * footprint);
    vec3 const scaled = (position + shift) * std::ldexp(1.0f, kFinest - widest);
    if (!(max_component(glm::abs(scaled)) < 0x1p20f)) return keys;
    vec3 normal = glm::cross(surface.edge1, surface.edge2);
    // A lampshade is bright inside and dark outside; both sides may have normals in the same direction.
    bool const back = glm::dot(normal, arrival) > 0;
    if (back) normal = -normal;
    std::uint64_t const what = std::uint64_t(surface.material) << 32 |
                               std::uint64_t(glm::clamp(further, 0, kMostFurther)) << 4 |
                               std::uint64_t(back) << 3 | side_of(normal);
    float scale = 0x1p-3f;
    static_assert(kFinest == 3);
    for (std::size_t l = 0; l < CacheKeys::kLevels; ++l, scale *= 2) {
        vec3 const place = glm::floor(scale * scaled);
        std::uint64_t where = 0;
        for (int c = 0; c < 3; ++c) where = where << 21 | (std::uint64_t(std::int64_t(place[c])) & 0x1fffff);
        std::uint64_t const level = std::uint64_t(widest - int(l) + 1024) << 10;
        keys.level[l] = mix_bits(where ^ mix_bits(what | level)) | 1;
    }
    return keys;
}

/// @param least  see least_level  @param sums_of  (key) -> CellSums, without notes if there is no such cell
template <class SumsOf>
GI_FN CachedRadiance read_cells(CacheKeys const& keys, std::size_t least, SumsOf const& sums_of)
{
    using namespace cache_detail;
    CachedRadiance known;
    float teaching = 0;
    for (std::size_t l = 0; l < CacheKeys::kLevels; ++l) {
        CellSums const c = sums_of(keys.level[l]);
        if (c.notes < 0) return {};
        if (l == 0 && c.notes < kEnough) break;
        if (c.notes > 0) {
            float const own = l > 0 ? c.notes / (c.notes + kPrior) : 1;
            known.radiance = own * (c.radiance / c.weight) + (1 - own) * known.radiance;
        }
        if (l > least)
            known.go_on = kEnough / (c.notes + kEnough);
        else if (l == least && c.notes >= kEnough)
            known.go_on = kEnough / c.notes;
        // Not the deviation of the cell that is read: those that happen to be bright have a larger one, paths would end in them
        // less often, and light would be lost.
        if (l == 0) teaching = glm::clamp(kTeaching * deviation(c), kLeastTeaching, kMostTeaching);
        if (l >= least && c.notes > 0) known.go_on = glm::max(known.go_on, teaching);
        if (c.notes < kSplit) break;
        known.to_teach = l + 2 < CacheKeys::kLevels ? l + 2 : CacheKeys::kLevels;
    }
    return known;
}

} // namespace gi
