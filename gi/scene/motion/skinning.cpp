#include "gi/scene/motion/skinning.h"

#include "gi/kernel/launch.h"
#include "gi/scene/motion/stretch.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace gi {
namespace {

Affine to_affine(glm::dmat3 const& linear, dvec3 offset)
{
    Affine a;
    for (int r = 0; r < 3; ++r)
        a.rows[r] = vec4(vec3(dvec3(linear[0][r], linear[1][r], linear[2][r])), float(offset[r]));
    return a;
}

Affine to_affine(dmat4 const& m) { return to_affine(glm::dmat3(m), dvec3(m[3])); }

double largest_entry(dmat4 const& m)
{
    double most = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) most = std::max(most, std::abs(m[c][r]));
    return most;
}

/// Reciprocal of the largest entry of some maps, as a power of two.
float shrink_for(double largest)
{
    if (!(largest > 1e-30) || !(largest < 1e30)) return 1;
    return float(std::exp2(-std::round(std::log2(largest))));
}

double determinant(dmat4 const& m) { return glm::determinant(glm::dmat3(m)); }

/// Splits the joints' maps into stretches and motions. @param centers  positions of the joints in the mesh at rest
void make_dual_quaternions(std::vector<dmat4> const& maps, std::vector<dvec3> const& centers,
                           InstancePlacement& to)
{
    double logarithms = 0;
    std::size_t counted = 0;
    for (dmat4 const& m : maps)
        if (double const volume = std::abs(determinant(m)); volume > 1e-90 && volume < 1e90) {
            logarithms += std::log(volume) / 3;
            ++counted;
        }
    double const shared = counted > 0 ? std::exp(logarithms / double(counted)) : 1; // scale of all joints
    bool even = true;
    to.stretches.clear();
    to.motions.clear();
    for (std::size_t j = 0; j < maps.size(); ++j) {
        glm::dmat3 const linear(maps[j]), rotation = nearest_rotation(linear);
        glm::dmat3 const stretch = glm::transpose(rotation) * linear;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) even &= std::abs(stretch[c][r] - (c == r ? shared : 0)) < 1e-6 * shared;
        // x -> stretch (x - center) + shared center, then the rotation,
        // then the translation to the mapped position.
        to.stretches.push_back(to_affine(stretch, shared * centers[j] - stretch * centers[j]));
        dvec3 const moved = dvec3(maps[j] * glm::dvec4(centers[j], 1)) - rotation * (shared * centers[j]);
        dquat const q = glm::normalize(glm::quat_cast(rotation));
        dquat const dual = 0.5 * (dquat(0, moved.x, moved.y, moved.z) * q);
        to.motions.push_back({vec4(float(q.x), float(q.y), float(q.z), float(q.w)),
                              vec4(float(dual.x), float(dual.y), float(dual.z), float(dual.w))});
    }
    if (even) to.stretches.assign(1, to_affine(glm::dmat3(shared), dvec3{0}));
}

dvec3 rest_place(mat4 const& inverse_bind)
{
    dmat4 const m(inverse_bind);
    if (!(std::abs(determinant(m)) > 1e-30)) return dvec3{0};
    return -(glm::inverse(glm::dmat3(m)) * dvec3(m[3]));
}

/// True if the joints reverse the winding, by the determinants at the first vertex that has weights.
bool joints_mirror(Mesh const& mesh, std::vector<dmat4> const& maps, bool node_mirrors)
{
    for (std::size_t v = 0; v < mesh.weights.size(); ++v) {
        double sum = 0, volume = 0;
        for (int k = 0; k < 4; ++k) {
            sum += double(mesh.weights[v][k]);
            volume += double(mesh.weights[v][k]) * determinant(maps[mesh.joints[v][std::size_t(k)]]);
        }
        if (sum > 0) return volume < 0;
    }
    return node_mirrors;
}

template <class Placement>
void run(Mesh const& mesh, MeshView const& m, Placement const& placement, InstancePlacement const& at,
         VertexViews const& out)
{
    DeformVertices<Placement> kernel;
    kernel.mesh = m;
    kernel.placement = placement;
    kernel.handedness = at.mirrored ? -1.0f : 1.0f;
    kernel.shrink = at.shrink;
    kernel.positions = out.positions;
    if (!mesh.normals.empty()) kernel.normals = out.normals;
    if (!mesh.tangents.empty()) kernel.tangents = out.tangents;
    launch(Space::host, "deform vertices", mesh.positions.size(), kernel);
}

} // namespace

vec3 center_of(Mesh const& mesh)
{
    constexpr float kFar = 4; // times the size; below this the rounding error is negligible
    vec3 low{kInf}, high{-kInf};
    for (vec3 const p : mesh.positions)
        // Other vertices are skipped (world.h), so they must not affect the centre.
        if (max_component(glm::abs(p)) <= kFarthest && all_finite(p)) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    if (!(low.x <= high.x)) return vec3{0};
    dvec3 const center = 0.5 * (dvec3(low) + dvec3(high));
    bool const far = glm::length(center) > double(kFar) * glm::length(dvec3(high) - dvec3(low));
    return far ? vec3(center) : vec3{0};
}

void place_instance(Scene const& scene, Pose const& pose, std::size_t node, Mesh const& mesh, vec3 center,
                    dvec3 origin, InstancePlacement& placement)
{
    auto const relative = [&](dmat4 m) { // maps from the centre, to positions relative to the origin
        m[3] = m * glm::dvec4(dvec3(center), 1) - glm::dvec4(origin, 0);
        return m;
    };
    std::vector<float> const& weights = pose.morph_weights[node];
    placement.morphs.clear();
    for (std::size_t t = 0; t < std::min(weights.size(), mesh.morph_targets.size()); ++t)
        if (weights[t] != 0) placement.morphs.emplace_back(std::uint32_t(t), weights[t]);

    dmat4 const whole = relative(pose.world_from_node[node]);
    placement.node = to_affine(whole);
    placement.mirrored = determinant(whole) < 0;
    double largest = largest_entry(whole);
    std::int32_t const skin_index = scene.nodes[node].skin;
    if (skin_index < 0 || mesh.joints.empty()) {
        placement.kind = InstancePlacement::Kind::rigid;
        placement.shrink = shrink_for(largest);
        return;
    }
    Skin const& skin = scene.skins[std::size_t(skin_index)];
    std::vector<dmat4> maps;
    largest = 0;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        dmat4 const bind(skin.inverse_bind[j]);
        maps.push_back(relative(pose.world_from_node[std::size_t(skin.joints[j])] * bind));
        largest = std::max(largest, largest_entry(maps.back()));
    }
    placement.mirrored = joints_mirror(mesh, maps, placement.mirrored);
    placement.shrink = shrink_for(largest);
    if (skin.method == SkinningMethod::linear) {
        placement.kind = InstancePlacement::Kind::linear;
        placement.joints.clear();
        for (dmat4 const& m : maps) placement.joints.push_back(to_affine(m));
    } else {
        placement.kind = InstancePlacement::Kind::dual_quaternion;
        std::vector<dvec3> centers;
        for (mat4 const& m : skin.inverse_bind) centers.push_back(rest_place(m) - dvec3(center));
        make_dual_quaternions(maps, centers, placement);
    }
}

void deform(Mesh const& mesh, vec3 center, InstancePlacement const& placement, VertexViews const& out)
{
    std::vector<MorphView> morphs;
    for (auto const& [target, weight] : placement.morphs) {
        MorphTarget const& t = mesh.morph_targets[target];
        morphs.push_back({t.positions, t.normals, t.tangents, weight});
    }
    MeshView const m{mesh.positions, mesh.normals, mesh.tangents, mesh.joints, mesh.weights, morphs, center};
    switch (placement.kind) {
    case InstancePlacement::Kind::rigid:
        return run(mesh, m, RigidPlacement{placement.node}, placement, out);
    case InstancePlacement::Kind::linear:
        return run(mesh, m, LinearPlacement{placement.node, placement.joints}, placement, out);
    case InstancePlacement::Kind::dual_quaternion:
        return run(mesh, m, DualQuaternionPlacement{placement.node, placement.motions, placement.stretches},
                   placement, out);
    }
}

DeformedVertices deform(Scene const& scene, Pose const& pose, std::size_t node, Mesh const& mesh, dvec3 origin)
{
    vec3 const center = center_of(mesh);
    InstancePlacement placement;
    place_instance(scene, pose, node, mesh, center, origin, placement);
    DeformedVertices out;
    out.mirrored = placement.mirrored;
    out.positions.resize(mesh.positions.size());
    out.normals.resize(mesh.normals.size());
    out.tangents.resize(mesh.tangents.size());
    deform(mesh, center, placement, {out.positions, out.normals, out.tangents});
    return out;
}

} // namespace gi
