#include "gi/methods/paths/radiance_cache.h"

#include "gi/core/rng.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Largest width of the widest level's cells relative to the footprint; rounding to powers of two can halve it.
/// This and the numbers below are measured: docs/decisions/radiance-cache.md.
constexpr float kWidth = 0.6f;
/// Number of notes required before paths end in a cell; with more, the probability of continuing falls inversely.
constexpr float kEnough = 3;
/// Lower limit of that probability: kTeaching times the relative deviation of the cell's notes, clamped to the
/// other two, because all pixels share a cell's error and no filter removes it. In a mean over reading and
/// teaching paths, teaching pays off in this proportion.
constexpr float kTeaching = 0.05f, kLeastTeaching = 0.03f, kMostTeaching = 0.3f;
/// Number of notes from which on cells of half the width are also taught.
constexpr float kSplit = 64;
/// The estimate of the wider cell has the weight of this many notes.
constexpr float kPrior = 8;
/// After this many passes, paths no longer end in the widest cells;
/// after kSlower times as many, nor in the next ones.
constexpr std::uint32_t kPassesOfWidest = 16, kSlower = 8;
/// Cells are separate by the number of scatterings that may follow; larger numbers than this share cells.
constexpr int kMostFurther = 16;
constexpr std::size_t kFirstCells = std::size_t(1) << 10;

/// Index of the side of a cube through which a normal points.
std::uint64_t side_of(vec3 n)
{
    vec3 const a = glm::abs(n);
    int const axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return std::uint64_t(2 * axis + (n[axis] < 0 ? 1 : 0));
}

} // namespace

RadianceCache::RadianceCache(float radius, std::size_t most_bytes)
    : most_cells_(std::max(kFirstCells, std::bit_floor(most_bytes / sizeof(Cell) / kShards))),
      shift_(1e-3f * radius * vec3{0.819f, 0.671f, 0.550f})
{
    clear();
}

CacheKeys RadianceCache::keys(Surface const& surface, vec3 position, vec3 arrival, float footprint,
                              int further) const
{
    CacheKeys keys;
    if (!(footprint > 0) || !(footprint < kInf)) return keys;
    constexpr int kFinest = int(CacheKeys::kLevels) - 1;
    int const widest = std::ilogb(kWidth * footprint);
    vec3 const scaled = (position + shift_) * std::ldexp(1.0f, kFinest - widest);
    if (!(max_component(glm::abs(scaled)) < 0x1p20f)) return keys;
    vec3 normal = glm::cross(surface.edge1, surface.edge2);
    // A lampshade is bright inside and dark outside; both sides may have normals in the same direction.
    bool const back = glm::dot(normal, arrival) > 0;
    if (back) normal = -normal;
    std::uint64_t const what = std::uint64_t(surface.material) << 32 |
                               std::uint64_t(std::clamp(further, 0, kMostFurther)) << 4 |
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

void RadianceCache::prefetch(CacheKeys const& keys) const
{
    for (std::uint64_t const key : keys.level) {
        Shard const& s = shard(key);
        __builtin_prefetch(&s.cells[s.slot(key)]);
    }
}

std::size_t RadianceCache::least_level() const
{
    std::size_t level = 0;
    for (std::uint32_t most = kPassesOfWidest; passes_ >= most && level + 1 < CacheKeys::kLevels; most *= kSlower)
        ++level;
    return level;
}

RadianceCache::CachedRadiance RadianceCache::find(CacheKeys const& keys) const
{
    CachedRadiance known;
    std::size_t const least = least_level();
    for (std::size_t l = 0; l < CacheKeys::kLevels; ++l) {
        Cell const* const c = shard(keys.level[l]).find(keys.level[l]);
        float const notes = c != nullptr ? c->notes : 0;
        if (notes < 0) return {};
        if (l == 0 && notes < kEnough) break;
        if (notes > 0) {
            float const own = l > 0 ? notes / (notes + kPrior) : 1;
            known.radiance = own * (c->sum / c->weight) + (1 - own) * known.radiance;
        }
        if (l > least)
            known.go_on = kEnough / (notes + kEnough);
        else if (l == least && notes >= kEnough)
            known.go_on = kEnough / notes;
        if (l >= least && notes > 0)
            known.go_on =
                std::max(known.go_on, glm::clamp(kTeaching * c->deviation(), kLeastTeaching, kMostTeaching));
        if (notes < kSplit) break;
        known.to_teach = std::min(l + 2, CacheKeys::kLevels);
    }
    return known;
}

float RadianceCache::Cell::deviation() const
{
    float const mean = luminance(sum) / notes;
    float const squared = mean > 0 ? squares / (notes * mean * mean) - 1 : 0;
    return squared < kInf ? std::sqrt(std::max(0.0f, squared)) : 0;
}

RadianceCache::Cell const* RadianceCache::Shard::find(std::uint64_t key) const
{
    for (std::size_t at = slot(key);; at = (at + 1) & (cells.size() - 1)) {
        if (cells[at].key == key) return &cells[at];
        if (cells[at].key == 0) return nullptr;
    }
}

/// Returns null if there is no room.
RadianceCache::Cell* RadianceCache::Shard::add(std::uint64_t key, std::size_t most)
{
    std::size_t at = slot(key);
    for (; cells[at].key != 0; at = (at + 1) & (cells.size() - 1))
        if (cells[at].key == key) return &cells[at];
    if (2 * (used + 1) > cells.size()) {
        if (2 * cells.size() > most) return nullptr;
        grow();
        return add(key, most);
    }
    ++used;
    cells[at].key = key;
    return &cells[at];
}

void RadianceCache::Shard::grow()
{
    std::vector<Cell> old(2 * cells.size());
    old.swap(cells);
    for (Cell const& c : old) {
        if (c.key == 0) continue;
        std::size_t at = slot(c.key);
        while (cells[at].key != 0) at = (at + 1) & (cells.size() - 1);
        cells[at] = c;
    }
}

void RadianceCache::learn(std::span<std::vector<CacheNote> const> blocks)
{
    auto const add = [&](Shard& s, CacheNote const& note, std::uint64_t key) {
        Cell* const c = s.add(key, most_cells_);
        if (c == nullptr) {
            ++s.refused;
        } else if (note.directional || c->notes < 0) {
            c->notes = -1;
        } else if (note.weight > 0 && all_finite(note.radiance)) {
            c->sum += note.weight * note.radiance;
            c->weight += note.weight;
            c->notes += 1;
            float const brought = note.weight * luminance(note.radiance);
            c->squares += brought * brought;
        }
    };
    tbb::parallel_for(std::size_t(0), kShards, [&](std::size_t k) {
        for (std::vector<CacheNote> const& notes : blocks)
            for (CacheNote const& note : notes)
                for (std::uint64_t const key : note.keys.level)
                    if (key != 0 && shard_of(key) == k) add(shards_[k], note, key);
    });
}

void RadianceCache::clear()
{
    for (Shard& s : shards_) {
        s.cells.assign(std::max(kFirstCells, s.cells.size()), Cell{});
        s.used = 0;
    }
    passes_ = 0;
}

std::size_t RadianceCache::cells() const
{
    std::size_t sum = 0;
    for (Shard const& s : shards_) sum += s.used;
    return sum;
}

std::size_t RadianceCache::bytes() const
{
    std::size_t sum = 0;
    for (Shard const& s : shards_) sum += s.cells.size() * sizeof(Cell);
    return sum;
}

std::uint64_t RadianceCache::refused() const
{
    std::uint64_t sum = 0;
    for (Shard const& s : shards_) sum += s.refused;
    return sum;
}

} // namespace gi
