#pragma once
// Whether look-ups in hit buffers of some resolution can be trusted where a camera looks. A look-up sees the
// column under a texel's centre in place of that under its origin; where the four columns around the origin answer
// alike, both see the same. Texels that are too large for a place (a room in a large world, windows, furniture)
// disagree, or do not have the surface that the look-up starts from, or are large beside what lies before the
// camera.

#include "gi/raster/triangle_soup.h"
#include "gi/scene/model/camera.h"

namespace gi {

/// @return  share of look-ups whose four columns have their surface and agree, of points that the camera sees and
/// of what is met from there along two axes; 1 where it sees nothing, 0 where a texel is larger than a sixteenth
/// of the median distance to what the camera sees
/// @param camera  not orthographic  @param resolution  texels of a hit buffer on a side
double look_up_agreement(World const& world, TriangleSoup const& soup, CameraRays const& camera,
                         std::uint32_t resolution);

} // namespace gi
