#pragma once
// Edge blending of overlapping projectors, whose light adds up. In its blend band a wall's light rises with t,
// 0 at the edge and 1 at the end of the band: (2t)^p / 2 up to t = 1/2, then 1 - (2 (1 - t))^p / 2.
// The curve and its mirror image sum to one (Bourke 2004, "Edge blending using commodity projectors";
// viewer/devices/gl/wall_pass.h draws the same). Bands of two sides multiply,
// so four projectors at a corner also sum to one.

#include "viewer/displays/display.h"

namespace viewer {

/// Share of the light at (u, v) of a wall, from 0 at an edge with a band to 1 inside; 0 outside the wall.
double blend_weight(WallBlend const& blend, double width_m, double height_m, double u, double v);
/// Factor for a pixel value encoded with blend.gamma that multiplies its light by `weight`.
double encoded_weight(WallBlend const& blend, double weight);
/// True if the wall needs a pass over the finished picture.
bool needs_finish(Wall const& wall);

} // namespace viewer
