#include "ar/scene/proxy_mesh.h"

#include "gi/core/file.h"
#include "gi/scene/load/load.h"

#include <glm/gtc/matrix_transform.hpp>

namespace ar {
namespace {

using gi::vec2, gi::vec3;

/// A face whose texture coordinates go from `low` to `high`; as printed, so v falls along edge_v.
void add_quad(gi::Mesh& mesh, gi::dvec3 corner, gi::dvec3 edge_u, gi::dvec3 edge_v, vec2 low, vec2 high)
{
    auto const first = std::uint32_t(mesh.positions.size());
    vec3 const normal(glm::normalize(glm::cross(edge_u, edge_v)));
    for (int k = 0; k < 4; ++k) {
        float const s = float(k % 2), t = float(k / 2);
        mesh.positions.push_back(vec3(corner + double(s) * edge_u + double(t) * edge_v));
        mesh.normals.push_back(normal);
        mesh.uv0.push_back({glm::mix(low.x, high.x, s), glm::mix(high.y, low.y, t)});
    }
    mesh.triangles.push_back({first, first + 1, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 2});
}

gi::Mesh mesh_of(ProxyPlane const& p)
{
    gi::Mesh mesh;
    add_quad(mesh, p.corner_m, p.edge_u_m, p.edge_v_m, {0, 0}, {1, 1});
    return mesh;
}

gi::Mesh mesh_of(ProxyBox const& b)
{
    gi::Mesh mesh;
    for (int axis = 0, face = 0; axis < 3; ++axis)
        for (double const side : {1.0, -1.0}) {
            // Right and up as seen from in front of the face, with the box upright.
            gi::dvec3 out{0}, up{0, 1, 0};
            out[axis] = side;
            if (axis == 1) up = {0, 0, -side};
            gi::dvec3 const u = glm::cross(up, out) * b.size_m, v = up * b.size_m;
            auto const world = [&](gi::dvec3 d) { return b.world_from_box.rotation * d; };
            gi::dvec3 const corner = b.world_from_box.position + world(0.5 * (out * b.size_m - u - v));
            vec2 const low{float(face % 3) / 3, float(face / 3) / 2};
            add_quad(mesh, corner, world(u), world(v), low, low + vec2(1.0f / 3, 0.5f));
            ++face;
        }
    return mesh;
}

gi::Material material_of(ProxySurface const& s, gi::TexturePool& pool)
{
    gi::Material m;
    m.base_color = vec3(s.albedo);
    m.roughness = float(s.roughness);
    m.metallic = float(s.metallic);
    m.specular = float(s.specular);
    if (s.from == AlbedoFrom::texture) {
        auto const bytes = gi::read_bytes(s.texture, std::size_t(1) << 30);
        m.base_color = vec3(1);
        m.base_color_map.texture = gi::add_texture(pool, bytes.data(), bytes.size(), true, s.texture.string());
        pool.textures.back().wrap_u = pool.textures.back().wrap_v = gi::Wrap::clamp;
    }
    return m;
}

gi::Scene of_mesh(gi::Mesh mesh)
{
    gi::Scene scene;
    scene.meshes.push_back(std::move(mesh));
    gi::Node node;
    node.meshes = {0};
    scene.nodes.push_back(std::move(node));
    return scene;
}

struct Shape {
    gi::Report& report;

    gi::Scene operator()(ProxyPlane const& p) const { return of_mesh(mesh_of(p)); }
    gi::Scene operator()(ProxyBox const& b) const { return of_mesh(mesh_of(b)); }
    gi::Scene operator()(ProxyDepth const& d) const { return of_mesh(mesh_of(d, report)); }
    gi::Scene operator()(ProxyMesh const& m) const
    {
        gi::Scene scene;
        gi::append(scene, gi::load_scene(m.placed.scene.string(), report), "mesh", placement(m.placed));
        return scene;
    }
};

} // namespace

gi::dmat4 placement(PlacedScene const& p)
{
    return glm::translate(gi::dmat4(1), p.at_m) *
           glm::rotate(gi::dmat4(1), glm::radians(p.turn_deg), gi::dvec3(0, 1, 0)) *
           glm::scale(gi::dmat4(1), gi::dvec3(p.scale));
}

gi::Scene scene_of(Proxy const& proxy, gi::Report& report)
{
    gi::Scene scene = std::visit(Shape{report}, proxy.shape);
    scene.name = proxy.name;
    for (gi::Mesh& m : scene.meshes) m.name = proxy.name;
    if (proxy.surface.from == AlbedoFrom::materials) return scene;
    scene.textures = {};
    scene.materials = {material_of(proxy.surface, scene.textures)};
    scene.material_names = {proxy.name};
    for (gi::Mesh& m : scene.meshes) {
        m.material = 0;
        m.colors.clear();
    }
    return scene;
}

} // namespace ar
