#pragma once
// What the rasterisers are held to: one triangle after the other, through the scan alone.

#include "gi/raster/fragments.h"
#include "gi/raster/scan_triangle.h"
#include "gi/raster/triangle_soup.h"

namespace gi::test {

/// Appends the fragments of triangles first..last - 1.
inline void rasterize_plain(TriangleSoup const& soup, std::size_t first, std::size_t last, RasterGrid const& grid,
                            MacroPath macro, Fragments& out)
{
    auto const subpixels = std::int32_t(grid.subpixels);
    for (std::size_t k = first; k < last; ++k) {
        vec3 const a = soup.vertex(k, 0), b = soup.vertex(k, 1), c = soup.vertex(k, 2);
        SnappedTriangle const t = snap(grid, a, b, c);
        TriangleScan const s = start_scan(t, subpixels, grid.width, grid.height);
        if (s.empty) continue;
        DepthPlane const plane = depth_plane(t, subpixels, {grid.depth(a), grid.depth(b), grid.depth(c)});
        std::uint32_t const id = std::uint32_t(k) | (s.along ? kAlongAxis : 0);
        scan(s, macro, [&](std::uint32_t j, std::uint32_t from, std::uint32_t to) {
            for (std::uint32_t i = from; i <= to; ++i) out.append(j * grid.width + i, plane.at(i, j), id);
        });
    }
}

} // namespace gi::test
