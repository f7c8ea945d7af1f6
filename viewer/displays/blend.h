#pragma once
// Light of overlapping projectors adds up. Within the band of its blend a wall's light rises with t, 0 at its edge
// and 1 at the end of the band, as (2t)^p / 2 up to t = 1/2 and 1 - (2 (1 - t))^p / 2 from there on, which with
// its mirror image makes one (Bourke 2004, "Edge blending using commodity projectors";
// viewer/devices/gl/wall_pass.h draws the same). Bands of two sides multiply, so four projectors over a corner
// make one too.

#include "viewer/displays/display.h"

namespace viewer {

/// Share of the light at (u, v) of a wall, from 0 at an edge with a band to 1 inside; 0 outside the wall.
double blend_weight(WallBlend const& blend, double width_m, double height_m, double u, double v);
/// What a pixel's value, encoded with blend.gamma, is multiplied by so that its light is multiplied by `weight`.
double encoded_weight(WallBlend const& blend, double weight);
/// Anything to do for a pass over the finished picture?
bool needs_finish(Wall const& wall);

} // namespace viewer
