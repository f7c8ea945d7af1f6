#include "gi/scene/skinning.h"

namespace gi {
namespace {

vec3 unit(dvec3 v)
{
    double const length = glm::length(v);
    return length > 0 && std::isfinite(length) ? vec3(v / length) : vec3{0};
}

/// The inverse transpose but for its length, which also exists where the transform flattens space.
glm::dmat3 normal_matrix(dmat4 const& m)
{
    dvec3 const x(m[0]), y(m[1]), z(m[2]);
    glm::dmat3 const cofactors(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
    return glm::dot(x, glm::cross(y, z)) < 0 ? -cofactors : cofactors;
}

/// A vector field of the mesh with its morph targets added.
template <class T>
std::vector<dvec3> morphed(std::vector<T> const& base, Mesh const& mesh, std::vector<float> const& weights,
                           std::vector<vec3> MorphTarget::*field)
{
    std::vector<dvec3> out;
    out.reserve(base.size());
    for (T const& v : base) out.push_back(dvec3(v));
    for (std::size_t t = 0; t < std::min(weights.size(), mesh.morph_targets.size()); ++t) {
        std::vector<vec3> const& delta = mesh.morph_targets[t].*field;
        if (weights[t] == 0 || delta.empty()) continue;
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += double(weights[t]) * dvec3(delta[i]);
    }
    return out;
}

} // namespace

DeformedVertices deform(Scene const& scene, Pose const& pose, std::size_t node, Mesh const& mesh)
{
    std::vector<float> const& weights = pose.morph_weights[node];
    std::vector<dvec3> positions = morphed(mesh.positions, mesh, weights, &MorphTarget::positions);
    std::vector<dvec3> normals = morphed(mesh.normals, mesh, weights, &MorphTarget::normals);
    std::vector<dvec3> tangents = morphed(mesh.tangents, mesh, weights, &MorphTarget::tangents);

    std::int32_t const skin_index = scene.nodes[node].skin;
    bool const skinned = skin_index >= 0 && !mesh.joints.empty();
    std::vector<dmat4> joints;
    if (skinned) {
        Skin const& skin = scene.skins[std::size_t(skin_index)];
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            joints.push_back(pose.world_from_node[std::size_t(skin.joints[j])] * dmat4(skin.inverse_bind[j]));
    }
    dmat4 const whole = pose.world_from_node[node];
    auto const matrix_of = [&](std::size_t vertex) {
        dmat4 m(0.0);
        double sum = 0;
        for (int k = 0; k < 4; ++k) {
            auto const w = double(mesh.weights[vertex][k]);
            m += w * joints[mesh.joints[vertex][std::size_t(k)]];
            sum += w;
        }
        return sum > 0 ? m / sum : whole;
    };

    DeformedVertices out;
    out.positions.resize(positions.size());
    out.normals.resize(normals.size());
    out.tangents.resize(tangents.size());
    glm::dmat3 const whole_normal = normal_matrix(whole);
    double mirroring = glm::determinant(glm::dmat3(whole));
    if (skinned && !positions.empty()) mirroring = glm::determinant(glm::dmat3(matrix_of(0)));
    out.mirrored = mirroring < 0;
    float const handedness = out.mirrored ? -1.0f : 1.0f;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        dmat4 const m = skinned ? matrix_of(i) : whole;
        out.positions[i] = dvec3(m * glm::dvec4(positions[i], 1));
        if (!normals.empty()) out.normals[i] = unit((skinned ? normal_matrix(m) : whole_normal) * normals[i]);
        if (!tangents.empty())
            out.tangents[i] = vec4(unit(glm::dmat3(m) * tangents[i]), mesh.tangents[i].w * handedness);
    }
    return out;
}

} // namespace gi
