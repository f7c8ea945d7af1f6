#pragma once
// Converts proxies to scenes.

#include "ar/scene/proxies.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

namespace ar {

/// Scene in world coordinates, with one material named like the proxy, or with the mesh file's own materials.
/// Albedos to be estimated are grey. Texture coordinates are those of `ProxySurface::texture`.
/// @throws gi::InputError, gi::InputError files that cannot be read
gi::Scene scene_of(Proxy const& proxy, gi::Report& report);

/// Triangulates a depth map, without a material. Pixels without a depth and triangles across depth jumps are left
/// out and counted. Texture coordinates are those of the map: (0, 0) is its upper left corner.
gi::Mesh mesh_of(ProxyDepth const& depth, gi::Report& report);

} // namespace ar
