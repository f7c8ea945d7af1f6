#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <map>

namespace gi::test {

Material lambert(vec3 albedo)
{
    Material m;
    m.base_color = albedo;
    m.specular = 0;
    m.double_sided = true;
    return m;
}

Material emitter(vec3 radiance, bool double_sided)
{
    Material m = lambert(vec3{0});
    m.emission = radiance;
    m.double_sided = double_sided;
    return m;
}

Material mirror(vec3 f0)
{
    Material m;
    m.base_color = f0;
    m.metallic = 1;
    m.roughness = 0;
    return m;
}

Material glass(float ior, bool thin)
{
    Material m;
    m.base_color = vec3{1};
    m.transmission = 1;
    m.roughness = 0;
    m.ior = ior;
    m.thin = thin;
    return m;
}

int add_material(Scene& scene, Material const& material)
{
    scene.materials.push_back(material);
    scene.material_names.push_back("m" + std::to_string(scene.materials.size()));
    return int(scene.materials.size()) - 1;
}

namespace {

void add_mesh(Scene& scene, Mesh mesh)
{
    Node node;
    node.meshes = {std::int32_t(scene.meshes.size())};
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(node);
}

} // namespace

void add_quad(Scene& scene, vec3 corner, vec3 u, vec3 v, int material)
{
    Mesh mesh;
    mesh.name = "quad";
    mesh.material = material;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    add_mesh(scene, std::move(mesh));
}

void add_box(Scene& scene, vec3 low, vec3 high, int material, bool inwards)
{
    vec3 const d = high - low;
    vec3 const x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
    auto const face = [&](vec3 corner, vec3 u, vec3 v) {
        inwards ? add_quad(scene, corner, v, u, material) : add_quad(scene, corner, u, v, material);
    };
    face(low, y, x);
    face(low + z, x, y);
    face(low, x, z);
    face(low + y, z, x);
    face(low, z, y);
    face(low + x, y, z);
}

void add_sphere(Scene& scene, vec3 center, float radius, int subdivisions, int material, bool smooth)
{
    std::vector<vec3> points;
    float const g = 0.5f * (1 + std::sqrt(5.0f));
    for (float const a : {-1.0f, 1.0f})
        for (float const b : {-g, g})
            for (vec3 const p : {vec3{0, a, b}, vec3{a, b, 0}, vec3{b, 0, a}}) points.push_back(glm::normalize(p));
    std::vector<uvec3> triangles;
    float const edge = 2 / std::sqrt(1 + g * g) * 1.01f;
    for (unsigned i = 0; i < 12; ++i)
        for (unsigned j = i + 1; j < 12; ++j)
            for (unsigned k = j + 1; k < 12; ++k) {
                if (glm::distance(points[i], points[j]) > edge || glm::distance(points[j], points[k]) > edge ||
                    glm::distance(points[i], points[k]) > edge)
                    continue;
                bool const outward =
                    glm::dot(glm::cross(points[j] - points[i], points[k] - points[i]), points[i]) > 0;
                triangles.push_back(outward ? uvec3{i, j, k} : uvec3{i, k, j});
            }
    for (int s = 0; s < subdivisions; ++s) {
        std::map<std::pair<unsigned, unsigned>, unsigned> middle;
        auto const split = [&](unsigned a, unsigned b) {
            auto const [it, fresh] = middle.try_emplace(std::minmax(a, b), unsigned(points.size()));
            if (fresh) points.push_back(glm::normalize(points[a] + points[b]));
            return it->second;
        };
        std::vector<uvec3> finer;
        for (uvec3 const t : triangles) {
            unsigned const a = split(t.x, t.y), b = split(t.y, t.z), c = split(t.z, t.x);
            for (uvec3 const f : {uvec3{t.x, a, c}, uvec3{t.y, b, a}, uvec3{t.z, c, b}, uvec3{a, b, c}})
                finer.push_back(f);
        }
        triangles = std::move(finer);
    }
    Mesh mesh;
    mesh.name = "sphere";
    mesh.material = material;
    for (vec3 const p : points) mesh.positions.push_back(center + radius * p);
    if (smooth) mesh.normals = points;
    mesh.triangles = std::move(triangles);
    add_mesh(scene, std::move(mesh));
}

void add_light(Scene& scene, Light const& light)
{
    Node node;
    node.light = std::int32_t(scene.lights.size());
    scene.lights.push_back(light);
    vec3 const d = glm::normalize(light.direction);
    node.translation = dvec3(light.position);
    vec3 const axis = glm::cross(vec3{0, 0, -1}, d);
    if (glm::length(axis) > 1e-6f)
        node.rotation = glm::angleAxis(std::acos(-double(d.z)), dvec3(glm::normalize(axis)));
    else if (d.z > 0)
        node.rotation = glm::angleAxis(glm::pi<double>(), dvec3{0, 1, 0});
    scene.nodes.push_back(node);
}

void set_environment(Scene& scene, vec3 radiance)
{
    EnvironmentMap map;
    map.width = 16;
    map.height = 8;
    map.radiance.assign(128, radiance);
    scene.environment = map;
}

World world_of(Scene scene)
{
    Report report;
    return build_world(std::make_shared<Scene const>(std::move(scene)), std::nullopt, report);
}

Camera orthographic(dvec3 from, dvec3 at, double height_m)
{
    Camera c = look_at(from, at, 45);
    c.orthographic = true;
    c.ymag_m = 0.5 * height_m;
    return c;
}

Estimate mean_of(Picture const& picture, std::string const& name)
{
    Layer const* layer = picture.find(name);
    Layer const* variance = picture.find("variance");
    double sum = 0, var = 0;
    for (float const v : layer->data) sum += double(v);
    for (float const v : variance->data) var += double(v);
    double const n = double(layer->data.size());
    // The channels of a pixel share their paths, so they are taken as fully correlated.
    return {sum / n, std::sqrt(3 * var) / n};
}

void expect_estimate(Estimate const& e, double truth, std::string const& what)
{
    EXPECT_LE(std::abs(e.mean - truth), 0.005 * std::abs(truth)) << what << ": " << e.mean << " for " << truth;
    EXPECT_LE(std::abs(e.mean - truth), 3 * e.sigma + 2e-6 * std::abs(truth))
        << what << ": " << e.mean << " for " << truth << ", sigma " << e.sigma;
}

} // namespace gi::test
