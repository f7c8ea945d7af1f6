// The mannequin with a face, so that its viewing direction is visible.

#include "gi/scene/generate/figure.h"
#include "gi/scene/generate/generate.h"

#include <algorithm>

namespace gi {
namespace {

/// Adds an ellipsoid that moves with one joint.
void add_ellipsoid(Mesh& m, vec3 center, vec3 radius, std::uint16_t joint)
{
    constexpr std::uint32_t kAround = 16, kRings = 8;
    auto const first = std::uint32_t(m.positions.size());
    for (std::uint32_t r = 0; r <= kRings; ++r)
        for (std::uint32_t s = 0; s <= kAround; ++s) {
            float const theta = kPi * float(r) / kRings, phi = 2 * kPi * float(s % kAround) / kAround;
            float const ring = r == 0 || r == kRings ? 0.0f : std::sin(theta);
            vec3 const n{ring * std::cos(phi), -std::cos(theta), ring * std::sin(phi)};
            m.positions.push_back(center + radius * n);
            m.normals.push_back(glm::normalize(n / radius));
            m.uv0.push_back({float(s) / kAround, float(r) / kRings});
            m.joints.push_back({joint, 0, 0, 0});
            m.weights.push_back({1, 0, 0, 0});
        }
    for (std::uint32_t r = 0; r < kRings; ++r)
        for (std::uint32_t s = 0; s < kAround; ++s) {
            std::uint32_t const a = first + r * (kAround + 1) + s, b = a + 1, c = a + kAround + 1, d = c + 1;
            if (r > 0) m.triangles.push_back({a, d, b});
            if (r + 1 < kRings) m.triangles.push_back({a, c, d});
        }
}

/// @param like  node that holds the mannequin's other meshes
void add_part(Scene& scene, Node const& like, std::string const& name, vec3 color, Mesh mesh)
{
    Material material;
    material.base_color = color;
    material.roughness = 0.4f;
    mesh.name = name;
    mesh.material = std::int32_t(scene.materials.size());
    scene.materials.push_back(material);
    scene.material_names.push_back(name);
    Node node;
    node.name = name;
    node.parent = like.parent;
    node.skin = like.skin;
    node.meshes = {std::int32_t(scene.meshes.size())};
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(std::move(node));
}

} // namespace

Scene generate_avatar()
{
    Scene scene;
    scene.name = "avatar";
    add_figure(scene, dmat4(1), 1);
    std::vector<std::int32_t> const& joints = scene.skins[0].joints;
    auto const head =
        std::uint16_t(std::find_if(joints.begin(), joints.end(),
                                   [&](std::int32_t j) { return scene.nodes[std::size_t(j)].name == "head"; }) -
                      joints.begin());
    Node const skin = scene.nodes.back();
    Mesh eyes, nose, hair;
    for (float const side : {-1.0f, 1.0f}) add_ellipsoid(eyes, {0.031f * side, 1.66f, 0.1f}, vec3{0.013f}, head);
    add_ellipsoid(nose, {0, 1.625f, 0.113f}, {0.012f, 0.024f, 0.018f}, head);
    add_ellipsoid(hair, {0, 1.69f, 0.0f}, {0.086f, 0.075f, 0.1f}, head);
    add_part(scene, skin, "avatar eyes", {0.03f, 0.03f, 0.04f}, std::move(eyes));
    add_part(scene, skin, "avatar nose", {0.6f, 0.36f, 0.27f}, std::move(nose));
    add_part(scene, skin, "avatar hair", {0.1f, 0.06f, 0.03f}, std::move(hair));
    return scene;
}

} // namespace gi
