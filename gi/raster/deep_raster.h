#pragma once
// Deep rasteriser: records every triangle over every texel centre of an orthographic view (Yu 2012, ch. 4).
//
// SIMD version: one triangle per lane. Triangles that cover no texel centre, as most do in scenes of millions, are
// dropped after projection; triangles over a few samples wait in queues until they fill a vector; large triangles
// are scanned one by one.

#include "gi/raster/fragments.h"
#include "gi/raster/scan_triangle.h"
#include "gi/raster/triangle_soup.h"

namespace gi {

/// Triangles whose bounds span more samples than this along one side are scanned one by one.
inline constexpr int kMicroSide = 4;

/// Appends the fragments of triangles first..last - 1.
void rasterize(TriangleSoup const& soup, std::size_t first, std::size_t last, RasterGrid const& grid,
               MacroPath macro, Fragments& out);

} // namespace gi
