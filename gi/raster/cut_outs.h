#pragma once
// Cut-outs (alpha masks, blending) are removed from the buffers when these are built, so that look-ups need no
// test. Partial coverage is a random decision per fragment.

#include "gi/core/rng.h"
#include "gi/raster/nearest_map.h"
#include "gi/scene/shading/shading_point.h"

namespace gi {

/// True if a triangle with alpha has a surface at a position in a texel (random if coverage is partial).
GI_FN inline bool is_there(WorldView const& world, std::uint32_t triangle, std::uint32_t texel, vec3 position,
                           std::uint32_t seed)
{
    float const covered = coverage(world, triangle, barycentric_at(world.surfaces[triangle], position));
    std::uint64_t const key = (std::uint64_t(seed) << 32) ^ (std::uint64_t(triangle) * 0x9e3779b1u + texel);
    return float(mix_bits(key) >> 40) * 0x1p-24f < covered;
}

/// For kernels: selects the fragments that exist, see DrawNearest and TrimLayers.
struct KeepUncut {
    WorldView world;
    View<std::uint8_t const> marked; ///< per triangle
    std::uint32_t seed = 0;

    GI_FN KeepUncut seeded(std::uint32_t of_raster) const { return {world, marked, of_raster}; }

    template <class Grid>
    GI_FN bool operator()(Grid const& grid, std::uint32_t triangle, std::uint32_t texel, float depth) const
    {
        return marked[triangle] == 0 ||
               is_there(world, triangle, texel, grid.point(texel % grid.width, texel / grid.width, depth), seed);
    }
};

class CutOuts {
public:
    /// Empty if all materials are opaque.
    explicit CutOuts(World const& world);

    bool none() const { return marked_.empty(); }
    std::vector<std::uint8_t> const& marked() const { return marked_; }
    /// Removes fragments that are cut out. @param seed  of the random decisions about partial coverage
    void remove(Fragments& fragments, RasterGrid const& grid, std::uint32_t seed) const;
    void remove(Fragments& fragments, PerspectiveGrid const& grid, std::uint32_t seed) const;

private:
    template <class Position>
    void remove_where(Fragments& fragments, std::uint32_t seed, Position const& position) const;

    WorldView world_;
    std::vector<std::uint8_t> marked_; ///< per triangle: 1 = has alpha
};

/// Draws triangles first..last - 1 into the map of a view, without their cut-outs. @param seed  as CutOuts::remove
void draw_view(TriangleSoup const& soup, std::size_t first, std::size_t last, CutOuts const& cut_outs,
               PerspectiveGrid const& grid, std::uint32_t seed, NearestMap& map);

} // namespace gi
