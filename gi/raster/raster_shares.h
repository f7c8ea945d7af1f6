#pragma once
// How a launch of the rasterisation kernels is divided among rasters, triangles and their shares.

#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.h"
#include "gi/kernel/scan.h"
#include "gi/raster/raster_kernels.h"

#include <span>

namespace gi {

template <Space S>
struct RasterShares {
    Buffer<std::uint32_t, S> before; ///< see SharesView
    std::size_t items = 0;           ///< of a launch
    std::uint32_t triangles = 0;

    SharesView view() const { return {before.view(), triangles}; }
};

/// @param soup, rasters  in space S
template <Space S, class Raster>
RasterShares<S> raster_shares(SoupView const& soup, View<Raster const> rasters)
{
    constexpr std::uint32_t kMost = 1 << 14;
    std::size_t const pairs = soup.count * rasters.size();
    RasterShares<S> shares{Buffer<std::uint32_t, S>(pairs + 1), pairs, std::uint32_t(soup.count)};
    View<std::uint32_t> const counts = shares.before.view();
    auto const most = std::uint32_t(glm::clamp(0x7fffffffu / (pairs + 1), std::size_t(1), std::size_t(kMost)));
    launch(S, "shares of triangles", pairs + 1, CountShares<Raster>{soup, rasters, most, counts});
    exclusive_scan(S, shares.view().before, counts);
    std::uint32_t further = 0;
    copy_bytes(Space::host, &further, S, counts.data + pairs, sizeof(further));
    shares.items += further;
    return shares;
}

/// Calls draw(first, last) for grids first..last - 1, as many together as a bound of memory allows: 128 MiB of shares,
/// and of 8 bytes a texel.
template <class Grid, class Draw>
void for_rasters_together(std::span<Grid const> grids, std::size_t triangles, Draw const& draw)
{
    constexpr std::size_t kPairs = std::size_t(1) << 25, kTexels = std::size_t(1) << 24;
    for (std::size_t first = 0; first < grids.size();) {
        std::size_t last = first, texels = 0;
        do texels += grids[last++].texels();
        while (last < grids.size() && (last + 1 - first) * triangles <= kPairs &&
               texels + grids[last].texels() <= kTexels);
        draw(first, last);
        first = last;
    }
}

} // namespace gi
