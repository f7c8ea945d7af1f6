#pragma once
// The radiance cache (radiance_cache.h) for kernels. Sums are integers, so that they are the same whatever the order in
// which threads add to them, as long as all notes have room: steps of a unit that is near the median of what paths bring, found in the first pass.
// Kernels read the sums of earlier passes while paths are traced, and add the notes of a pass when all paths have ended.

#include "gi/kernel/atomics.h"
#include "gi/kernel/columns.h"
#include "gi/methods/paths/cache_cells.h"
#include "gi/render/path_step.h"

#include <bit>

namespace gi {

/// One cell, 64 bytes. All zero = free.
struct alignas(64) CacheCell {
    std::uint64_t key;
    std::uint64_t radiance[3], weight, squares; ///< as in CellSums, in steps
    std::uint32_t notes, directional;           ///< directional > 0: no path may end here
    std::uint64_t unused;
};

/// A note whose path is still being traced, or has ended.
struct CacheNoteOnWay {
    std::uint32_t keys[2 * CacheKeys::kLevels]; ///< of the levels to teach, in halves; 0 = none
    vec3 throughput, before; ///< on arrival: the path's throughput, and its indirect light so far
    float weight;            ///< as in CacheNote
    std::uint32_t pixel;
    std::uint32_t directional; ///< 1: see is_directional

    GI_FN std::uint64_t key(std::size_t level) const
    {
        return std::uint64_t(keys[2 * level + 1]) << 32 | keys[2 * level];
    }
    GI_FN void set_key(std::size_t level, std::uint64_t key)
    {
        keys[2 * level] = std::uint32_t(key);
        keys[2 * level + 1] = std::uint32_t(key >> 32);
    }
    /// What it brought, luminance. @param light  of the path
    GI_FN vec3 radiance(PathSample const& light) const { return (light.radiance[2] - before) / throughput; }
    GI_FN float brought(PathSample const& light) const { return weight * luminance(radiance(light)); }
    GI_FN bool counts(PathSample const& light) const { return weight > 0 && all_finite(radiance(light)); }
};

/// Cells and notes, for paths.
struct CacheView {
    static constexpr float kWeightSteps = 0x1p20f, kRadianceSteps = 0x1p20f, kSquareSteps = 0x1p16f;
    static constexpr std::uint32_t kMostProbes = 256;

    View<CacheCell> cells; ///< a power of two; empty = there is no cache
    float unit = 1;        ///< W/(m^2 sr), a power of two
    vec3 shift{0};         ///< see cell_shift
    std::uint32_t least = 0;
    ColumnView<CacheNoteOnWay> notes;
    /// [0]: notes, also those without room, [1]: notes whose cells have no room, [2]: notes without room, [3]: cells taken
    View<std::uint32_t> count;

    GI_FN CellSums sums_of(std::uint64_t key) const
    {
        std::size_t at = key & (cells.size() - 1);
        for (std::uint32_t k = 0; k < kMostProbes; ++k, at = (at + 1) & (cells.size() - 1)) {
            CacheCell const& c = cells[at];
            if (c.key == 0) break;
            if (c.key != key) continue;
            if (c.directional > 0) return {vec3{0}, 0, -1, 0};
            float const step = unit / kRadianceSteps;
            return {step * vec3{float(c.radiance[0]), float(c.radiance[1]), float(c.radiance[2])},
                    float(c.weight) / kWeightSteps, float(c.notes), float(c.squares) * (unit * unit / kSquareSteps)};
        }
        return {};
    }
    /// The cell of a key, which is taken if it is new. Null = there is no room.
    GI_FN CacheCell* take(std::uint64_t key) const
    {
        std::size_t at = key & (cells.size() - 1);
        for (std::uint32_t k = 0; k < kMostProbes; ++k, at = (at + 1) & (cells.size() - 1)) {
            std::uint64_t const there = atomic_exchange_if(cells[at].key, 0, key);
            if (there == 0) atomic_add(count[3], 1);
            if (there == 0 || there == key) return &cells[at];
        }
        return nullptr;
    }
    /// Returns its index; notes.count = there is no room.
    GI_FN std::uint32_t open(CacheNoteOnWay const& note) const
    {
        std::uint32_t const at = atomic_add(count[0], 1);
        if (at < notes.count)
            notes.store(at, note);
        else
            atomic_add(count[2], 1);
        return at < notes.count ? at : std::uint32_t(notes.count);
    }
};

/// Item = note. Counts exponents of what notes bring, of which the unit is the median.
struct CountExponents {
    CacheView cache;
    View<PathSample const> samples;
    View<std::uint32_t> exponents; ///< 256, of floats

    GI_FN void operator()(std::size_t i) const
    {
        if (i >= cache.count[0]) return;
        CacheNoteOnWay const note = cache.notes.load(i);
        PathSample const light = samples[note.pixel];
        float const brought = note.brought(light);
        if (note.counts(light) && brought > 0) atomic_add(exponents[std::bit_cast<std::uint32_t>(brought) >> 23 & 255], 1);
    }
};

/// Item = note. Adds it to its cells.
struct LearnNotes {
    CacheView cache;
    View<PathSample const> samples;

    GI_FN void operator()(std::size_t i) const
    {
        if (i >= cache.count[0]) return;
        CacheNoteOnWay const note = cache.notes.load(i);
        PathSample const light = samples[note.pixel];
        bool const adds = note.counts(light);
        if (!adds && note.directional == 0) return;
        vec3 const radiance = note.weight * note.radiance(light);
        float const brought = luminance(radiance) / cache.unit;
        for (std::size_t level = 0; level < CacheKeys::kLevels; ++level) {
            std::uint64_t const key = note.key(level);
            if (key == 0) break;
            CacheCell* const c = cache.take(key);
            if (c == nullptr) {
                atomic_add(cache.count[1], 1);
            } else if (note.directional != 0) {
                atomic_add(c->directional, 1);
            } else {
                for (int k = 0; k < 3; ++k)
                    atomic_add(c->radiance[k], steps(radiance[k] / cache.unit, CacheView::kRadianceSteps));
                atomic_add(c->weight, steps(note.weight, CacheView::kWeightSteps));
                atomic_add(c->squares, steps(brought * brought, CacheView::kSquareSteps));
                atomic_add(c->notes, 1);
            }
        }
    }

private:
    /// Limited, so that the sum of a million notes has 64 bits.
    GI_FN static std::uint64_t steps(float value, float per_one)
    {
        constexpr float kMost = 0x1p43f;
        float const v = value * per_one + 0.5f;
        return v > 0 ? std::uint64_t(v < kMost ? v : kMost) : 0;
    }
};

/// Item = cell. Moves it to a larger table.
struct MoveCells {
    View<CacheCell const> from;
    CacheView to;

    GI_FN void operator()(std::size_t i) const
    {
        if (from[i].key == 0) return;
        CacheCell* const c = to.take(from[i].key);
        if (c != nullptr)
            *c = from[i];
        else
            atomic_add(to.count[1], 1);
    }
};

} // namespace gi
