#pragma once
// Outgoing radiance of surfaces, kept between passes in spatial cells:
// a path that has scattered ends where its cell is known, while some paths continue to teach the cell.
// The cells are hashed, as in the caches of games (Binder et al. 2019; Gautron 2020),
// but their width depends on the path's footprint and not on the distance from the eye,
// and a pass reads the state before the pass (or before its turn), so that threads do not affect the picture.
//
// Error: paths that end in a cell and paths that teach it are chosen at random from one distribution and weighted
// by their throughput, so that the mean over many pixels keeps its expectation. Within a pixel, light at second
// surfaces is blurred over a cell, which may extend through a thin wall, and pixels share the noise of a cell. So
// the cache is meant for pictures with a budget. Readable cells get narrower with the number of passes.

#include "gi/methods/paths/cache_cells.h"

#include <array>
#include <span>
#include <vector>

namespace gi {

/// Outgoing radiance found by a path that continued.
struct CacheNote {
    CacheKeys keys;           ///< of the levels to teach
    vec3 radiance;            ///< outgoing, W/(m^2 sr)
    float weight;             ///< luminance of the path's throughput / probability of continuing
    bool directional = false; ///< see is_directional: no path may end in these cells
};

class RadianceCache {
public:
    /// @param radius  of the world, m  @param most_bytes  memory limit; notes without a cell are counted
    RadianceCache(float radius, std::size_t most_bytes);

    /// See cell_keys.
    CacheKeys keys(Surface const& surface, vec3 position, vec3 arrival, float footprint, int further) const
    {
        return cell_keys(surface, shift_, position, arrival, footprint, further);
    }
    void prefetch(CacheKeys const& keys) const;

    CachedRadiance find(CacheKeys const& keys) const;

    /// Adds notes to cells. The order of notes affects the last bits, the number of threads does not.
    void learn(std::span<std::vector<CacheNote> const> notes);
    void end_pass() { ++passes_; }
    /// Passes that have ended; go_back: that many, as the later ones taught nothing.
    std::uint32_t passes() const { return passes_; }
    void go_back(std::uint32_t passes) { passes_ = passes; }
    /// Empties the cache, as light or geometry has changed.
    void clear();

    bool empty() const { return cells() == 0; }
    std::size_t cells() const;
    std::size_t bytes() const;
    std::uint64_t refused() const; ///< number of notes for which there was no free cell

private:
    struct Cell {
        std::uint64_t key = 0;
        CellSums sums;
    };
    /// Hash table of the keys with the same first bits: open addressing, power-of-two size.
    struct Shard {
        std::vector<Cell> cells;
        std::size_t used = 0;
        std::uint64_t refused = 0;

        std::size_t slot(std::uint64_t key) const { return std::size_t(key) & (cells.size() - 1); }
        Cell const* find(std::uint64_t key) const;
        Cell* add(std::uint64_t key, std::size_t most);
        void grow();
    };
    static constexpr std::size_t kShards = 16; ///< updated independently of each other
    static std::size_t shard_of(std::uint64_t key) { return std::size_t(key >> 60); }
    Shard const& shard(std::uint64_t key) const { return shards_[shard_of(key)]; }

    std::array<Shard, kShards> shards_;
    std::size_t most_cells_; ///< per shard
    std::uint32_t passes_ = 0;
    vec3 shift_; ///< see cell_shift
};

} // namespace gi
