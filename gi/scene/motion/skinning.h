#pragma once
// Computes the vertices of one instance of a mesh at one time: prepares the inputs of deform_kernels.h from a pose
// and runs the kernel.

#include "gi/core/view.h"
#include "gi/scene/motion/animation.h"
#include "gi/scene/motion/deform_kernels.h"

namespace gi {

/// Placement of one instance at one time; equal placements of one mesh give equal vertices.
/// Placing it again reuses its memory.
struct InstancePlacement {
    enum class Kind : std::uint8_t { rigid, linear, dual_quaternion } kind = Kind::rigid;
    Affine node;
    std::vector<Affine> joints;                          ///< linear
    std::vector<DualQuaternion> motions;                 ///< dual_quaternion
    std::vector<Affine> stretches;                       ///< dual_quaternion: one per joint, or one for all
    std::vector<std::pair<std::uint32_t, float>> morphs; ///< targets whose weight is not zero
    bool mirrored = false;                               ///< the transform reverses the winding
    float shrink = 1;                                    ///< see DeformVertices

    bool operator==(InstancePlacement const&) const = default;
};

/// Returns the point that DeformVertices subtracts from a mesh's positions, m: their centre
/// if they are far from zero, else 0.
vec3 center_of(Mesh const& mesh);

/// Places an instance. Joints replace the node's own transform (glTF 2, sec. 3.7.3.3), which applies only to
/// vertices without weights.
/// @param origin  m; the vertices will be relative to it
void place_instance(Scene const& scene, Pose const& pose, std::size_t node, Mesh const& mesh, vec3 center,
                    dvec3 origin, InstancePlacement& placement);

/// Output arrays for vertices: each is as long as the mesh's positions, or empty if not needed.
struct VertexViews {
    View<vec3> positions, normals;
    View<vec4> tangents;
};

/// Runs the kernel on the host. Normals and tangents that the mesh does not have are not written.
void deform(Mesh const& mesh, vec3 center, InstancePlacement const& placement, VertexViews const& out);

struct DeformedVertices {
    std::vector<vec3> positions; ///< m, relative to the given origin
    std::vector<vec3> normals;   ///< unit; empty if the mesh's are
    std::vector<vec4> tangents;  ///< xyz unit; empty if the mesh's are
    bool mirrored = false;       ///< the transform reverses the winding
};

/// Combines the functions above for one mesh at one node.
DeformedVertices deform(Scene const& scene, Pose const& pose, std::size_t node, Mesh const& mesh,
                        dvec3 origin = dvec3{0});

} // namespace gi
