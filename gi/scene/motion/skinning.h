#pragma once
// Vertices of one instance of a mesh at a moment: what deform_kernels.h needs, made from a pose, and the call to
// it.

#include "gi/core/view.h"
#include "gi/scene/motion/animation.h"
#include "gi/scene/motion/deform_kernels.h"

namespace gi {

/// Where one instance is at one moment: equal placements of one mesh give equal vertices. The memory is used again
/// when it is placed anew.
struct InstancePlacement {
    enum class Kind : std::uint8_t { rigid, linear, dual_quaternion } kind = Kind::rigid;
    Affine node;
    std::vector<Affine> joints;                          ///< linear
    std::vector<DualQuaternion> motions;                 ///< dual_quaternion
    std::vector<Affine> stretches;                       ///< dual_quaternion: one per joint, or one for all
    std::vector<std::pair<std::uint32_t, float>> morphs; ///< targets whose weight is not zero
    bool mirrored = false;                               ///< the transform turns the winding round
    float shrink = 1;                                    ///< see DeformVertices

    bool operator==(InstancePlacement const&) const = default;
};

/// The point that DeformVertices takes off a mesh's positions, m: their centre where they lie far from zero, else
/// 0.
vec3 center_of(Mesh const& mesh);

/// Joints replace the node's own transform (glTF 2, sec. 3.7.3.3), which only vertices without weights follow.
/// @param origin  m; the vertices will be relative to it
void place_instance(Scene const& scene, Pose const& pose, std::size_t node, Mesh const& mesh, vec3 center,
                    dvec3 origin, InstancePlacement& placement);

/// Where vertices go: each view is as long as the mesh's positions, or empty where they are not wanted.
struct VertexViews {
    View<vec3> positions, normals;
    View<vec4> tangents;
};

/// Runs the kernel on the host. Normals and tangents that the mesh does not have are not written.
void deform(Mesh const& mesh, vec3 center, InstancePlacement const& placement, VertexViews const& out);

struct DeformedVertices {
    std::vector<vec3> positions; ///< m, relative to the origin that was given
    std::vector<vec3> normals;   ///< unit, or empty as the mesh's
    std::vector<vec4> tangents;  ///< xyz unit, or empty as the mesh's
    bool mirrored = false;       ///< the transform turns the winding round
};

/// All of the above for one mesh at one node.
DeformedVertices deform(Scene const& scene, Pose const& pose, std::size_t node, Mesh const& mesh,
                        dvec3 origin = dvec3{0});

} // namespace gi
