#include "gi/scene/generate/builder.h"

#include <algorithm>

namespace gi {

Material matt(vec3 albedo)
{
    Material m;
    m.base_color = albedo;
    m.specular = 0;
    return m;
}

int SceneBuilder::add_material(std::string const& name, Material const& material)
{
    scene_.materials.push_back(material);
    scene_.material_names.push_back(name);
    Mesh mesh;
    mesh.name = name;
    mesh.material = std::int32_t(scene_.materials.size()) - 1;
    meshes_.push_back(std::move(mesh));
    return int(meshes_.size()) - 1;
}

Mesh& SceneBuilder::mesh_of(int material) { return meshes_[std::size_t(material)]; }

void SceneBuilder::grid(int material, int nu, int nv, std::function<GridVertex(float, float)> const& point)
{
    Mesh& m = mesh_of(material);
    auto const first = std::uint32_t(m.positions.size());
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i) {
            GridVertex const v = point(float(i) / float(nu), float(j) / float(nv));
            m.positions.push_back(v.position);
            m.normals.push_back(v.normal);
            m.uv0.push_back(v.uv);
        }
    auto const row = std::uint32_t(nu) + 1;
    for (std::uint32_t j = 0; j < std::uint32_t(nv); ++j)
        for (std::uint32_t i = 0; i < std::uint32_t(nu); ++i) {
            std::uint32_t const a = first + j * row + i, b = a + 1, c = a + row, d = c + 1;
            auto const add = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
                bool const empty = m.positions[p] == m.positions[q] || m.positions[q] == m.positions[r] ||
                                   m.positions[r] == m.positions[p];
                if (!empty) m.triangles.push_back({p, q, r}); // cells at the poles have only one triangle
            };
            add(a, b, d);
            add(a, d, c);
        }
}

void SceneBuilder::quad(int material, vec3 corner, vec3 u, vec3 v, float uv_per_m, int nu, int nv)
{
    vec3 const n = glm::normalize(glm::cross(u, v));
    vec2 const size = uv_per_m * vec2{glm::length(u), glm::length(v)};
    grid(material, nu, nv, [&](float s, float t) {
        return GridVertex{corner + s * u + t * v, n, {s * size.x, (1 - t) * size.y}};
    });
}

void SceneBuilder::box(int material, vec3 low, vec3 high, float uv_per_m)
{
    vec3 const d = high - low;
    vec3 const x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
    quad(material, low + z, x, y, uv_per_m);
    quad(material, low + x, -x, y, uv_per_m);
    quad(material, low, z, y, uv_per_m);
    quad(material, low + x + z, -z, y, uv_per_m);
    quad(material, low + y + z, x, -z, uv_per_m);
    quad(material, low, x, z, uv_per_m);
}

void SceneBuilder::lathe(int material, vec3 foot, std::vector<vec2> const& profile, int segments)
{
    auto const last = profile.size() - 1;
    auto const tangent = [&](std::size_t i) {
        return glm::normalize(profile[std::min(i + 1, last)] - profile[i > 0 ? i - 1 : 0]);
    };
    grid(material, segments, int(last), [&](float u, float v) {
        auto const i = std::min(std::size_t(std::lround(v * float(last))), last);
        // Both ends of the seam use the same angle, so that it closes exactly.
        float const angle = u < 1 ? 2 * kPi * u : 0.0f;
        vec3 const out{std::sin(angle), 0, std::cos(angle)};
        vec2 const t = tangent(i);
        return GridVertex{foot + profile[i].x * out + vec3{0, profile[i].y, 0},
                          glm::normalize(t.y * out - vec3{0, t.x, 0}),
                          {4 * u, profile[i].y}};
    });
}

void SceneBuilder::sphere(int material, vec3 center, float radius, int segments)
{
    int const rings = std::max(2, segments / 2);
    grid(material, segments, rings, [&](float u, float v) {
        float const phi = u < 1 ? 2 * kPi * u : 0.0f, theta = kPi * (1 - v);
        float const s = v == 0 || v == 1 ? 0.0f : std::sin(theta);
        vec3 const n{s * std::sin(phi), v == 0 ? -1.0f : v == 1 ? 1.0f : std::cos(theta), s * std::cos(phi)};
        return GridVertex{center + radius * n, n, {u, 1 - v}};
    });
}

void SceneBuilder::add_camera(std::string const& name, dvec3 from, dvec3 at, double yfov_deg)
{
    Camera camera = look_at(from, at, yfov_deg);
    camera.name = name;
    Node node;
    node.name = name;
    node.matrix = camera.world_from_camera;
    node.camera = std::int32_t(scene_.cameras.size());
    scene_.cameras.push_back(camera);
    scene_.nodes.push_back(std::move(node));
}

void SceneBuilder::add_light(std::string const& name, Light light, dvec3 position, dvec3 direction)
{
    light.position = vec3(position);
    light.direction = vec3(glm::normalize(direction));
    Node node;
    node.name = name;
    dvec3 const z = -glm::normalize(direction);
    Frame const f = Frame::about(vec3(z));
    node.matrix = dmat4(glm::dvec4(dvec3(f.tangent), 0), glm::dvec4(dvec3(f.bitangent), 0), glm::dvec4(z, 0),
                        glm::dvec4(position, 1));
    node.light = std::int32_t(scene_.lights.size());
    scene_.lights.push_back(light);
    scene_.nodes.push_back(std::move(node));
}

Scene SceneBuilder::finish(std::string const& name)
{
    for (Mesh& mesh : meshes_) {
        if (mesh.triangles.empty()) continue;
        Node node;
        node.name = mesh.name;
        node.meshes = {std::int32_t(scene_.meshes.size())};
        scene_.meshes.push_back(std::move(mesh));
        scene_.nodes.push_back(std::move(node));
    }
    scene_.name = name;
    return std::move(scene_);
}

} // namespace gi
