#pragma once
// The order in which triangles are drawn: by material, and in clusters of near ones.

#include "gi/surfaces/shown_scene.h"

#include <stop_token>

namespace viewer {

/// Triangles one after the other.
struct SurfaceRange {
    std::uint32_t first = 0, count = 0;
};

struct SurfaceCluster {
    SurfaceRange triangles;
    gi::Bounds bounds; ///< m, from the world's origin; infinite: they move
};

/// Triangles of one material.
struct SurfacePart {
    std::uint32_t material = 0;
    SurfaceRange triangles;
    std::vector<SurfaceCluster> clusters; ///< of all of them
};

struct SurfaceOrder {
    std::vector<gi::uvec3> triangles; ///< their vertices, of the world
    std::vector<SurfacePart> parts;
};

/// Of what never moves; or of what can, which has one cluster a material.
/// @param stop  what is returned after a request is of no use
SurfaceOrder order_surfaces(gi::ShownScene const& scene, bool moves, std::stop_token const& stop);

} // namespace viewer
