#pragma once
// Smooth normals for meshes that have none.

#include "gi/scene/model/scene.h"

namespace gi {

/// Per vertex the mean of its triangles' normals, weighted by their angles at it (Thuermer and Wuethrich 1998,
/// "Computing vertex normals from polygonal facets"), so that the cutting of faces into triangles does not show.
/// Unit; zero (= flat shaded) at vertices without a triangle that has an area. Vertices are smooth where triangles
/// share them by index.
std::vector<vec3> vertex_normals(std::vector<vec3> const& positions, std::vector<uvec3> const& triangles);

} // namespace gi
