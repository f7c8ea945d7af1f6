#pragma once
// How a launch of the rasterisation kernels is divided among triangles and their shares.

#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.h"
#include "gi/kernel/scan.h"
#include "gi/raster/raster_kernels.h"

namespace gi {

template <Space S>
struct RasterShares {
    Buffer<std::uint32_t, S> before; ///< see SharesView
    std::size_t items = 0;           ///< of a launch

    SharesView view() const { return {before.view()}; }
};

/// @param soup  in space S
template <Space S, class Grid>
RasterShares<S> raster_shares(SoupView const& soup, Grid const& grid)
{
    constexpr std::uint32_t kMost = 1 << 14;
    RasterShares<S> shares{Buffer<std::uint32_t, S>(soup.count + 1), soup.count};
    View<std::uint32_t> const counts = shares.before.view();
    auto const most =
        std::uint32_t(glm::clamp(0x7fffffffu / (soup.count + 1), std::size_t(1), std::size_t(kMost)));
    launch(S, "shares of triangles", soup.count + 1, CountShares<Grid>{soup, grid, most, counts});
    exclusive_scan(S, shares.view().before, counts);
    std::uint32_t further = 0;
    copy_bytes(Space::host, &further, S, counts.data + soup.count, sizeof(further));
    shares.items += further;
    return shares;
}

} // namespace gi
