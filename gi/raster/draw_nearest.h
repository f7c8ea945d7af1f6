#pragma once
// Draws NearestMaps with kernels, on host or device.

#include "gi/raster/raster_shares.h"

namespace gi {

/// Returns the texels of each grid, row-major, as NearestMap::texels. @param soup  in space S
/// @param seeds  of cut-outs, one per grid
template <Space S, class Grid, class Keep = KeepAll>
std::vector<Buffer<NearestTexel, S>> draw_nearest(SoupView const& soup, std::span<Grid const> grids,
                                                  std::span<std::uint32_t const> seeds, Keep const& keep = {})
{
    std::vector<Buffer<NearestTexel, S>> out;
    for_rasters_together(grids, soup.count, [&](std::size_t first, std::size_t last) {
        std::vector<NearestRaster<Grid>> rasters;
        std::uint32_t cells = 0;
        for (std::size_t k = first; k < last; ++k) {
            out.emplace_back(grids[k].texels());
            rasters.push_back({grids[k], cells, seeds[k], out.back().view().data});
            cells += std::uint32_t(grids[k].texels());
        }
        Buffer<NearestRaster<Grid>, S> const there = upload<S>(rasters);
        Buffer<std::uint64_t, S> best(cells);
        fill_bytes(S, best.view().data, 0, cells * sizeof(std::uint64_t));
        RasterShares<S> const shares = raster_shares<S>(soup, there.view());
        launch(S, "draw nearest", shares.items,
               DrawNearest<Grid, Keep>{soup, there.view(), keep, shares.view(), best.view()});
        launch(S, "unpack nearest", cells, UnpackNearest<Grid>{there.view(), std::as_const(best).view()});
    });
    return out;
}

/// The same for one grid.
template <Space S, class Grid, class Keep = KeepAll>
Buffer<NearestTexel, S> draw_nearest(SoupView const& soup, Grid const& grid, std::uint32_t seed = 0,
                                     Keep const& keep = {})
{
    return std::move(
        draw_nearest<S>(soup, std::span<Grid const>(&grid, 1), std::span<std::uint32_t const>(&seed, 1), keep)
            .front());
}

} // namespace gi
