#pragma once
// Finds the surface under the mouse, and what stands in the way.

#include "gi/scene/model/camera.h"
#include "gi/scene/model/world.h"

namespace viewer {

/// The surface seen at a point of a picture.
struct Picked {
    std::uint32_t triangle = 0, node = 0, material = 0; ///< indices into the world, the scene, the world
    double distance_m = 0;
    gi::dvec3 position{0}; ///< m, absolute
};

/// Nearest triangle on the camera ray through (x, y) in [0, 1]^2 of its picture, (0, 0) top left. Tests every
/// triangle: milliseconds for a million. Triangles without area are never hit.
std::optional<Picked> pick(gi::World const& world, gi::Camera const& camera, double aspect, glm::dvec2 at);

/// Distance to the nearest triangle, at most `most_m`. Takes as long as pick().
/// @param from  m, absolute  @param direction  unit
double free_way_m(gi::World const& world, gi::dvec3 from, gi::dvec3 direction, double most_m);

} // namespace viewer
