#pragma once
// Meshes at nodes: where each lies in the arrays of a World, and how its vertices and triangles get there.

#include "gi/core/report.h"
#include "gi/scene/model/world.h"
#include "gi/scene/motion/motion.h"
#include "gi/scene/motion/skinning.h"

#include <string>

namespace gi {

/// One mesh at one node.
struct Instance {
    std::size_t node = 0;
    Mesh const* mesh = nullptr;
    vec3 center{0};                                   ///< center_of(*mesh)
    std::string why_moving;                           ///< empty = it cannot
    std::size_t first_vertex = 0, first_triangle = 0; ///< in the World
    InstancePlacement placement;
    std::uint64_t unusable_vertices = 0;  ///< not finite or beyond 1e18 m, at the present moment
    std::optional<bool> corners_mirrored; ///< the mesh's corners are written, mirrored or not

    bool moves() const { return !why_moving.empty(); }
};

/// All instances, those that cannot move first; first_vertex is set. Throws InputError if a count overflows 32
/// bits.
std::vector<Instance> find_instances(Scene const& scene);

/// Sizes the arrays of vertices and fills in what time does not change: texture coordinates, colours, and zeros
/// for normals and tangents that a mesh does not have.
void prepare_vertices(World& world, std::vector<Instance> const& instances);

/// Vertices of an instance, from its placement; they must be there for the triangles.
void deform_into(World& world, Instance const& instance);

/// Append the triangles of an instance that cannot move, but for those that are not finite or have no area
/// (reported).
void append_static_triangles(World& world, Instance& instance, Report& report);
/// Append all triangles of an instance that moves, with no corners yet.
void append_moving_triangles(World& world, Instance& instance);
/// The corners of a moving instance's triangles at this moment. Vertices that are not usable go to the origin, and
/// triangles that have one become points, so that nothing that is not finite is in the World.
void write_moving_triangles(World& world, Instance& instance);

/// What some triangles take up, and how many of them have no area.
struct TriangleExtent {
    Bounds bounds; ///< of those with area
    std::uint64_t flat = 0;
};
TriangleExtent measure_triangles(World const& world, std::size_t first, std::size_t end);

} // namespace gi
