#include "gi/raster/cut_outs.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {

CutOuts::CutOuts(World const& world) : world_(view(world))
{
    auto const is_cut = [](Material const& m) { return m.alpha_mode != AlphaMode::opaque; };
    if (std::ranges::none_of(world.materials, is_cut)) return;
    marked_.resize(world.triangles.size());
    for (std::size_t t = 0; t < marked_.size(); ++t)
        marked_[t] = is_cut(world.materials[world.triangle_material[t]]) ? 1 : 0;
}

template <class Position>
void CutOuts::remove_where(Fragments& f, std::uint32_t seed, Position const& position) const
{
    if (none()) return;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < f.count; ++k) {
        std::uint32_t const triangle = f.primitive[k] & kPrimitiveMask;
        if (marked_[triangle] != 0 &&
            !is_there(world_, triangle, f.texel[k], position(f.texel[k], f.depth[k]), seed))
            continue;
        f.texel[kept] = f.texel[k];
        f.depth[kept] = f.depth[k];
        f.primitive[kept++] = f.primitive[k];
    }
    f.count = kept;
}

void CutOuts::remove(Fragments& fragments, RasterGrid const& grid, std::uint32_t seed) const
{
    remove_where(fragments, seed, [&](std::uint32_t texel, float depth) {
        return grid.point(texel % grid.width, texel / grid.width, depth);
    });
}

void CutOuts::remove(Fragments& fragments, PerspectiveGrid const& grid, std::uint32_t seed) const
{
    remove_where(fragments, seed, [&](std::uint32_t texel, float depth) {
        return grid.point(texel % grid.width, texel / grid.width, depth);
    });
}

void draw_view(TriangleSoup const& soup, std::size_t first, std::size_t last, CutOuts const& cut_outs,
               PerspectiveGrid const& grid, std::uint32_t seed, NearestMap& map)
{
    constexpr std::size_t kPart = 32 * TriangleSoup::kChunk;
    tbb::parallel_for(std::size_t(0), (last - first + kPart - 1) / kPart, [&](std::size_t k) {
        BorrowedFragments fragments;
        rasterize(soup, first + k * kPart, std::min(last, first + (k + 1) * kPart), grid, *fragments);
        cut_outs.remove(*fragments, grid, seed);
        resolve_shared(*fragments, 1, map);
    });
}

} // namespace gi
