#include "gi/methods/paths/radiance_cache.h"

#include <algorithm>
#include <bit>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr std::size_t kFirstCells = std::size_t(1) << 10;

} // namespace

RadianceCache::RadianceCache(float radius, std::size_t most_bytes)
    : most_cells_(std::max(kFirstCells, std::bit_floor(most_bytes / sizeof(Cell) / kShards))),
      shift_(cell_shift(radius))
{
    clear();
}

void RadianceCache::prefetch(CacheKeys const& keys) const
{
    for (std::uint64_t const key : keys.level) {
        Shard const& s = shard(key);
        __builtin_prefetch(&s.cells[s.slot(key)]);
    }
}

CachedRadiance RadianceCache::find(CacheKeys const& keys) const
{
    return read_cells(keys, least_level(passes_), [this](std::uint64_t key) {
        Cell const* const c = shard(key).find(key);
        return c != nullptr ? c->sums : CellSums{};
    });
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
        Cell* const cell = s.add(key, most_cells_);
        if (cell == nullptr) {
            ++s.refused;
            return;
        }
        CellSums& c = cell->sums;
        if (note.directional || c.notes < 0) {
            c.notes = -1;
        } else if (note.weight > 0 && all_finite(note.radiance)) {
            c.radiance += note.weight * note.radiance;
            c.weight += note.weight;
            c.notes += 1;
            float const brought = note.weight * luminance(note.radiance);
            c.squares += brought * brought;
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
