#pragma once
// Proxies as scenes.

#include "ar/scene/proxies.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

namespace viewer {

/// In world coordinates, with one material called by the proxy's name; of a mesh that keeps its materials: with
/// those of its file. What is to be estimated is grey. Texture coordinates are those of `ProxySurface::texture`.
/// @throws gi::InputError files that cannot be read
gi::Scene scene_of(ArProxy const& proxy, gi::Report& report);

/// A map of depths as triangles, without a material. Pixels without a depth and triangles across jumps are left
/// out and counted. Texture coordinates are those of the map: (0, 0) is its upper left corner.
gi::Mesh mesh_of(ProxyDepth const& depth, gi::Report& report);

} // namespace viewer
