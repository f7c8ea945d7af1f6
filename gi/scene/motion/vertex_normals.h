#pragma once
// Smooth normals for meshes that have none.

#include "gi/scene/model/scene.h"

namespace gi {

/// Returns per vertex the mean of its triangles' normals, weighted by their angles at the vertex (Thuermer and
/// Wuethrich 1998, "Computing vertex normals from polygonal facets"), so that the triangulation of faces does not
/// show. Unit; zero (= flat shaded) at vertices whose triangles all have no area. Shading is smooth across
/// triangles that share vertices by index.
std::vector<vec3> vertex_normals(std::vector<vec3> const& positions, std::vector<uvec3> const& triangles);

} // namespace gi
