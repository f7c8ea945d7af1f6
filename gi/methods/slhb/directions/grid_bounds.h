#pragma once
// The box that hit buffers and the shadow maps of parallel light cover, while something in it moves.

#include "gi/raster/triangle_soup.h"
#include "gi/scene/motion/moving_world.h"

namespace gi {

/// Everything, and room around what moves, so that an arm that swings is no reason to build all anew.
Bounds grid_bounds(World const& world, TriangleSoup const& soup, std::size_t first_moving);
/// Where the world has left them, they grow, with some room, so that it does not happen in every frame.
/// @return whether they did, and all that covers them has to be made anew
bool grow(Bounds& bounds, Bounds const& world);

/// Whether lamps have to be chosen anew.
inline bool changes_lamps(Changes const& c) { return c.lights || c.light_select || c.emitters || c.environment; }

} // namespace gi
