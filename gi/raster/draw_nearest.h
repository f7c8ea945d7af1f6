#pragma once
// Draws a NearestMap with kernels, on host or device.

#include "gi/raster/raster_shares.h"

namespace gi {

/// Returns texels row-major, as NearestMap::texels. @param soup  in space S
template <Space S, class Grid, class Keep = KeepAll>
Buffer<NearestTexel, S> draw_nearest(SoupView const& soup, Grid const& grid, Keep const& keep = {})
{
    std::size_t const texels = grid.texels();
    Buffer<std::uint64_t, S> best(texels);
    fill_bytes(S, best.view().data, 0, texels * sizeof(std::uint64_t));
    RasterShares<S> const shares = raster_shares<S>(soup, grid);
    launch(S, "draw nearest", shares.items, DrawNearest<Grid, Keep>{soup, grid, keep, shares.view(), best.view()});
    Buffer<NearestTexel, S> out(texels);
    launch(S, "unpack nearest", texels, UnpackNearest{std::as_const(best).view(), out.view()});
    return out;
}

} // namespace gi
