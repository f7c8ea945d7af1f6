#pragma once
// Instances of meshes at nodes: their ranges in the arrays of a World, and writing their vertices and triangles.

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
    std::string why_moving;                           ///< empty = it cannot move
    std::size_t first_vertex = 0, first_triangle = 0; ///< in the World
    InstancePlacement placement;
    std::uint64_t unusable_vertices = 0;  ///< not finite or beyond 1e18 m, at the current time
    std::optional<bool> corners_mirrored; ///< winding of the corners in World; empty = must be written

    bool moves() const { return !why_moving.empty(); }
};

/// Returns all instances, static ones first, with first_vertex set.
/// Throws InputError if a count overflows 32 bits.
std::vector<Instance> find_instances(Scene const& scene);

/// Resizes the vertex arrays and writes the time-independent attributes: texture coordinates, colours, and zeros
/// for normals and tangents that a mesh does not have.
void prepare_vertices(World& world, std::vector<Instance> const& instances);

/// Writes the world positions, normals and tangents of an instance's vertices, as its placement moves, skins and
/// morphs them. Call it before append_static_triangles() or write_moving_triangles().
void deform_into(World& world, Instance const& instance);

/// Appends the triangles of a static instance; skips and reports those that are not finite or have no area.
void append_static_triangles(World& world, Instance& instance, Report& report);
/// Appends all triangles of a moving instance, without corners.
void append_moving_triangles(World& world, Instance& instance);
/// Writes the corners of a moving instance's triangles. Unusable vertices are moved to the origin and triangles
/// that have one become points, so that the World contains only finite values.
void write_moving_triangles(World& world, Instance& instance);

/// Bounds of a range of triangles, and the number of those without area.
struct TriangleExtent {
    Bounds bounds; ///< of the triangles with area
    std::uint64_t flat = 0;
};
TriangleExtent measure_triangles(World const& world, std::size_t first, std::size_t end);

} // namespace gi
