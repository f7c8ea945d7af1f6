#pragma once
// The default camera of a scene without one: inside rooms at eye height above a floor;
// around objects, outside with all of them in view. Chosen by rays: the same scene always gives the same camera.

#include "gi/scene/model/world.h"

#include <optional>

namespace viewer {

/// Bounds of the part of a scene where its detail is: the planes that cut off 1 % of the triangles'
/// corners on each side of each axis, widened by a tenth. A ground plane of a few triangles does not count,
/// however wide it is. Frame: World.
gi::Bounds detailed_part(gi::World const& world);

/// Looks for a place to stand: points on a grid of the detailed part, at eye height (1.6 m, or what the part's
/// height allows) above surfaces that face upward and have room above them. A place is inside if nearly all rays
/// near the horizontal meet the front of a surface. Of these, the one that sees farthest all around is taken, and
/// the horizontal direction with the most to see: long views, in which distances and surfaces vary.
/// @return nothing if no place is inside; or if few places are and the scene is open to the view
/// from outside, as the Cornell box is
std::optional<gi::Camera> view_from_inside(gi::World const& world, double fov_deg);

/// Shows all of the bounds from the front, a little from the right and above.
gi::Camera view_from_outside(gi::World const& world, gi::Bounds const& bounds, double fov_deg);

} // namespace viewer
