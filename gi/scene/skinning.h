#pragma once
// Vertices of one instance of a mesh in world space: morph targets, then linear blend skinning or the node's
// transform.

#include "gi/scene/animation.h"

namespace gi {

struct DeformedVertices {
    std::vector<dvec3> positions;
    std::vector<vec3> normals;  ///< unit, or empty as the mesh's
    std::vector<vec4> tangents; ///< xyz unit, or empty as the mesh's
    bool mirrored = false;      ///< the transform turns the winding round
};

/// Joints replace the node's own transform (glTF 2, sec. 3.7.3.3).
DeformedVertices deform(Scene const& scene, Pose const& pose, std::size_t node, Mesh const& mesh);

} // namespace gi
