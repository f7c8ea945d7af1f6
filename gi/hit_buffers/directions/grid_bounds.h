#pragma once
// The box covered by hit buffers and by the shadow maps of parallel lights, in scenes with dynamic geometry.

#include "gi/raster/triangle_soup.h"
#include "gi/scene/motion/moving_world.h"

namespace gi {

/// Bounds of everything, with room around dynamic geometry, so that small motion does not require a rebuild.
Bounds grid_bounds(World const& world, TriangleSoup const& soup, std::size_t first_moving);
/// Enlarges the bounds if the world has left them, with extra room so that this does not happen in every frame.
/// @return true if they grew; everything that covers them must then be rebuilt
bool grow(Bounds& bounds, Bounds const& world);

/// True if light points have to be chosen again.
inline bool changes_lights(Changes const& c) { return c.lights || c.light_select || c.emitters || c.environment; }

} // namespace gi
