#pragma once
// Draws a NearestMap with kernels, on host or device.

#include "gi/kernel/launch.h"
#include "gi/raster/raster_kernels.h"

namespace gi {

/// Returns texels row-major, as NearestMap::texels. @param soup  in space S
template <Space S, class Grid, class Keep = KeepAll>
Buffer<NearestTexel, S> draw_nearest(SoupView const& soup, Grid const& grid, Keep const& keep = {})
{
    std::size_t const texels = grid.texels();
    Buffer<std::uint64_t, S> best(texels);
    fill_bytes(S, best.view().data, 0, texels * sizeof(std::uint64_t));
    std::uint32_t const shares = shares_for(soup.count);
    launch(S, "draw nearest", soup.count * shares, DrawNearest<Grid, Keep>{soup, grid, keep, shares, best.view()});
    Buffer<NearestTexel, S> out(texels);
    launch(S, "unpack nearest", texels, UnpackNearest{std::as_const(best).view(), out.view()});
    return out;
}

} // namespace gi
