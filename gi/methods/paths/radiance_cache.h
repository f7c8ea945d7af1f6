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

#include "gi/scene/model/world.h"
#include "gi/scene/shading/narrow_lobes.h"

#include <array>
#include <span>
#include <vector>

namespace gi {

/// The cells that contain a point where a path can end: from the widest, each half as wide as the one before.
struct CacheKeys {
    static constexpr std::size_t kLevels = 4;
    std::array<std::uint64_t, kLevels> level{}; ///< 0 = none

    bool any() const { return level[0] != 0; }
};

/// Outgoing radiance found by a path that continued.
struct CacheNote {
    CacheKeys keys;           ///< of the levels to teach
    vec3 radiance;            ///< outgoing, W/(m^2 sr)
    float weight;             ///< luminance of the path's throughput / probability of continuing
    bool directional = false; ///< see is_directional: no path may end in these cells
};

/// True if outgoing light depends so much on direction that paths cannot share it: mirrors, glass, and narrow
/// lobes except the weak one of a coat.
inline bool is_directional(Bsdf const& b)
{
    constexpr float kWeak = 0.1f;
    if (b.clear > 0 || (b.f90.x > 0 && b.alpha < kSmoothAlpha)) return true;
    return has_narrow_lobe(b) && max_component(b.model == MaterialModel::phong ? b.phong_specular : b.f0) > kWeak;
}

class RadianceCache {
public:
    /// @param radius  of the world, m  @param most_bytes  memory limit; notes without a cell are counted
    RadianceCache(float radius, std::size_t most_bytes);

    /// Returns equal keys for points on the same material and the same side of triangles, with similar
    /// orientation, in the same cell. Empty if floats are too coarse for cells this narrow.
    /// @param footprint  width of the bundle that the path represents, m  @param arrival  direction of the path
    /// @param further  number of scatterings that may follow, >= 0
    CacheKeys keys(Surface const& surface, vec3 position, vec3 arrival, float footprint, int further) const;
    void prefetch(CacheKeys const& keys) const;

    /// Known outgoing radiance at a point.
    struct CachedRadiance {
        vec3 radiance{0};
        float go_on = 1;          ///< probability that a path continues anyway, to teach; 1 = nothing known
        std::size_t to_teach = 1; ///< number of levels to teach, from the widest
    };
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
        vec3 sum{0};                 ///< of weight times radiance
        float weight = 0, notes = 0; ///< notes < 0: no path may end here
        float squares = 0;           ///< sum of (weight times luminance)^2

        float deviation() const; ///< relative standard deviation of weight times luminance
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
    std::size_t least_level() const;

    std::array<Shard, kShards> shards_;
    std::size_t most_cells_; ///< per shard
    std::uint32_t passes_ = 0;
    vec3 shift_; ///< m, so that axis-aligned walls do not coincide with cell borders
};

} // namespace gi
