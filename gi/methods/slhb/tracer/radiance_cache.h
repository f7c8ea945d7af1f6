#pragma once
// Light that surfaces send on, kept from pass to pass in cells of space: a path that has scattered ends where its
// cell is known, and some go on to teach it. The cells are hashed, as in the caches of games (Binder et al. 2019;
// Gautron 2020), but their width follows the footprint of the path and not the distance from the eye, and a pass
// reads them as they were before it (or before its turn), so that threads do not change the picture.
//
// Error. Paths that end in a cell and paths that teach it are drawn from one distribution, by chance, and weighted
// by what they carry: the mean over many pixels keeps its expectation. In a pixel, light at second surfaces is
// blurred over a cell, which can lie on both sides of a thin wall; and pixels share the noise of a cell. So it is
// for pictures that time decides. Cells that may be read get narrower with the passes.

#include "gi/scene/model/world.h"
#include "gi/scene/shading/narrow_lobes.h"

#include <array>
#include <span>
#include <vector>

namespace gi {

/// Of a place that a path can end on: the cells that it lies in, from the widest, each half as wide as the last.
struct CacheKeys {
    static constexpr std::size_t kLevels = 4;
    std::array<std::uint64_t, kLevels> level{}; ///< 0 = none

    bool any() const { return level[0] != 0; }
};

/// What a path found that went on from there.
struct CacheNote {
    CacheKeys keys;           ///< of the levels that it teaches
    vec3 radiance;            ///< sent back, W/(m^2 sr)
    float weight;             ///< luminance of what the path carried, over the chance with which it went on
    bool directional = false; ///< see is_directional: nothing is to end in these cells
};

/// Whether what it sends back depends so much on the direction that paths cannot share it: mirrors, glass, narrow
/// lobes other than the weak one of a coat.
inline bool is_directional(Bsdf const& b)
{
    constexpr float kWeak = 0.1f;
    if (b.clear > 0 || (b.f90.x > 0 && b.alpha < kSmoothAlpha)) return true;
    return has_narrow_lobe(b) && max_component(b.model == MaterialModel::phong ? b.phong_specular : b.f0) > kWeak;
}

class RadianceCache {
public:
    /// @param radius  of the world, m  @param most_bytes  cells beyond are not kept, and counted
    RadianceCache(float radius, std::size_t most_bytes);

    /// The same for places on the same material and side of triangles, facing the same way, in the same cell. None
    /// where floats are too coarse for cells so narrow.
    /// @param footprint  m across, of the bundle that the path stands for  @param arrival  direction of the path
    /// @param further  scatterings that may follow, >= 0
    CacheKeys keys(Surface const& surface, vec3 position, vec3 arrival, float footprint, int further) const;
    void prefetch(CacheKeys const& keys) const;

    /// What is known of a place.
    struct CachedRadiance {
        vec3 radiance{0};
        float go_on = 1;          ///< chance with which a path goes on nevertheless, to teach; 1 = not known
        std::size_t to_teach = 1; ///< levels, from the widest
    };
    CachedRadiance find(CacheKeys const& keys) const;

    /// The order of notes decides the last bits, how many threads do not.
    void learn(std::span<std::vector<CacheNote> const> notes);
    void end_pass() { ++passes_; }
    /// Light or geometry is another.
    void clear();

    bool empty() const { return cells() == 0; }
    std::size_t cells() const;
    std::size_t bytes() const;
    std::uint64_t refused() const; ///< notes that no cell was left for

private:
    struct Cell {
        std::uint64_t key = 0;
        vec3 sum{0};                 ///< of weight times radiance
        float weight = 0, notes = 0; ///< notes < 0: nothing ends here
        float squares = 0;           ///< of weight times luminance

        float deviation() const; ///< standard, of weight times luminance, over their mean
    };
    /// Of keys with the same first bits: open addressing, a power of two.
    struct Shard {
        std::vector<Cell> cells;
        std::size_t used = 0;
        std::uint64_t refused = 0;

        std::size_t slot(std::uint64_t key) const { return std::size_t(key) & (cells.size() - 1); }
        Cell const* find(std::uint64_t key) const;
        Cell* add(std::uint64_t key, std::size_t most);
        void grow();
    };
    static constexpr std::size_t kShards = 16; ///< each learns by itself
    static std::size_t shard_of(std::uint64_t key) { return std::size_t(key >> 60); }
    Shard const& shard(std::uint64_t key) const { return shards_[shard_of(key)]; }
    std::size_t least_level() const;

    std::array<Shard, kShards> shards_;
    std::size_t most_cells_; ///< of a shard
    std::uint32_t passes_ = 0;
    vec3 shift_; ///< m, so that walls along axes do not lie on borders of cells
};

} // namespace gi
