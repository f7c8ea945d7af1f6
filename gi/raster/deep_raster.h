#pragma once
// The deep rasteriser: every triangle over every texel centre of an orthographic view (Yu 2012, ch. 4).
//
// Vector form: one triangle per lane. Triangles that fall between the texel centres, which most do when there are
// millions, are gone after projection; those over a few samples wait in queues until there is a vector of them;
// large ones are scanned one by one.

#include "gi/raster/fragments.h"
#include "gi/raster/scan_triangle.h"
#include "gi/raster/triangle_soup.h"

namespace gi {

/// Triangles whose bounds hold more samples than this on a side are scanned one by one.
inline constexpr int kMicroSide = 4;

/// Appends the fragments of triangles first..last - 1.
void rasterize(TriangleSoup const& soup, std::size_t first, std::size_t last, RasterGrid const& grid,
               MacroPath macro, Fragments& out);

} // namespace gi
