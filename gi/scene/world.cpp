#include "gi/scene/world.h"

#include "gi/base/error.h"
#include "gi/base/huge_pages.h"
#include "gi/scene/skinning.h"
#include "gi/scene/world_tables.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr double kFarthest = 1e18; ///< m; squares of larger coordinates overflow a float

/// One mesh at one node.
struct Instance {
    std::size_t node;
    Mesh const* mesh;
    std::size_t first_vertex, first_triangle;
};

struct Layout {
    std::vector<Instance> instances;
    std::size_t vertices = 0, triangles = 0;
    bool normals = false, tangents = false, uv0 = false, uv1 = false, colors = false;
};

Layout lay_out(Scene const& scene)
{
    Layout layout;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        for (std::int32_t const m : scene.nodes[n].meshes) {
            Mesh const& mesh = scene.meshes[std::size_t(m)];
            layout.instances.push_back({n, &mesh, layout.vertices, layout.triangles});
            layout.vertices += mesh.positions.size();
            layout.triangles += mesh.triangles.size();
            layout.normals |= !mesh.normals.empty();
            layout.tangents |= !mesh.tangents.empty();
            layout.uv0 |= !mesh.uv0.empty();
            layout.uv1 |= !mesh.uv1.empty();
            layout.colors |= !mesh.colors.empty();
        }
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (layout.vertices >= kMost || layout.triangles >= kMost)
        throw InputError(
            fmt::format("the scene has {} vertices and {} triangles", layout.vertices, layout.triangles),
            "indices have 32 bits", "leave out some instances");
    return layout;
}

struct DoubleBounds {
    dvec3 low{std::numeric_limits<double>::max()}, high{-std::numeric_limits<double>::max()};
    void add(dvec3 p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void add(DoubleBounds const& b)
    {
        low = glm::min(low, b.low);
        high = glm::max(high, b.high);
    }
    bool empty() const { return !(low.x <= high.x); }
};

bool usable(dvec3 p)
{
    return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest &&
           std::abs(p.z) <= kFarthest; // not NaN either
}

enum class TriangleState : std::uint8_t { good, not_finite, no_area };

TriangleState judge(dvec3 a, dvec3 b, dvec3 c)
{
    if (!usable(a) || !usable(b) || !usable(c)) return TriangleState::not_finite;
    dvec3 const area = glm::cross(b - a, c - a);
    return area == dvec3{0} ? TriangleState::no_area : TriangleState::good;
}

/// What one instance gives, before the world's origin is known.
struct Evaluated {
    DeformedVertices vertices;
    std::vector<TriangleState> states;
    DoubleBounds bounds;
};

Evaluated evaluate_instance(Scene const& scene, Pose const& pose, Instance const& instance)
{
    Evaluated e;
    e.vertices = deform(scene, pose, instance.node, *instance.mesh);
    e.states.reserve(instance.mesh->triangles.size());
    std::vector<dvec3> const& p = e.vertices.positions;
    for (uvec3 const t : instance.mesh->triangles) {
        TriangleState const state = judge(p[t.x], p[t.y], p[t.z]);
        e.states.push_back(state);
        if (state != TriangleState::good) continue;
        for (int k = 0; k < 3; ++k) e.bounds.add(p[t[k]]);
    }
    return e;
}

template <class T>
void copy_or_fill(std::vector<T> const& from, std::vector<T>& to, std::size_t first, std::size_t count, T fill)
{
    if (to.empty()) return;
    if (from.empty())
        std::fill_n(to.begin() + std::ptrdiff_t(first), count, fill);
    else
        std::copy(from.begin(), from.end(), to.begin() + std::ptrdiff_t(first));
}

void place_lights_and_cameras(World& world, Pose const& pose, Report& report)
{
    Scene const& scene = *world.scene;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        Node const& node = scene.nodes[n];
        dmat4 const& m = pose.world_from_node[n];
        dvec3 const back(m[2]);
        dvec3 const z = glm::length(back) > 0 ? glm::normalize(back) : dvec3{0, 0, 1};
        if (node.light >= 0) {
            Light light = scene.lights[std::size_t(node.light)];
            light.position = vec3(dvec3(m[3]) - world.origin);
            light.direction = vec3(-z);
            if (all_finite(light.position) && all_finite(light.direction))
                world.lights.push_back(light);
            else
                report.lose("lights not at a finite place, skipped", 1, "node '" + node.name + "'");
        }
        if (node.camera >= 0) {
            Camera camera = scene.cameras[std::size_t(node.camera)];
            dvec3 x = glm::cross(dvec3(m[1]), z);
            x = glm::length(x) > 0 ? glm::normalize(x) : dvec3(Frame::about(vec3(z)).tangent);
            camera.world_from_camera =
                dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), m[3]);
            if (camera.name.empty()) camera.name = node.name;
            bool finite = true;
            for (int c = 0; c < 4; ++c) finite &= std::isfinite(glm::length(camera.world_from_camera[c]));
            if (finite)
                world.cameras.push_back(std::move(camera));
            else
                report.lose("cameras not at a finite place, skipped", 1, "node '" + node.name + "'");
        }
    }
}

} // namespace

World build_world(std::shared_ptr<Scene const> scene, SceneTime time_s, Report& report)
{
    World world;
    world.scene = std::move(scene);
    Scene const& s = *world.scene;
    world.materials = s.materials;
    world.materials.push_back({});
    Pose const pose = evaluate_pose(s, time_s);
    Layout const layout = lay_out(s);
    std::size_t const n = layout.instances.size();

    std::vector<Evaluated> evaluated(n);
    tbb::parallel_for(std::size_t(0), n,
                      [&](std::size_t i) { evaluated[i] = evaluate_instance(s, pose, layout.instances[i]); });

    DoubleBounds bounds;
    for (Evaluated const& e : evaluated) bounds.add(e.bounds);
    if (!bounds.empty()) {
        dvec3 const center = 0.5 * (bounds.low + bounds.high);
        if (glm::length(center) > 500 * glm::length(bounds.high - bounds.low)) world.origin = center;
        world.bounds = {vec3(bounds.low - world.origin), vec3(bounds.high - world.origin)};
    }

    world.positions.resize(layout.vertices);
    if (layout.normals) resize_on_huge_pages(world.normals, layout.vertices);
    if (layout.tangents) resize_on_huge_pages(world.tangents, layout.vertices);
    if (layout.uv0) resize_on_huge_pages(world.uv0, layout.vertices);
    if (layout.uv1) resize_on_huge_pages(world.uv1, layout.vertices);
    if (layout.colors) resize_on_huge_pages(world.colors, layout.vertices);
    world.triangles.reserve(layout.triangles);
    world.triangle_material.reserve(layout.triangles);
    world.instances = std::uint32_t(n);
    for (std::size_t i = 0; i < n; ++i) {
        Instance const& instance = layout.instances[i];
        Mesh const& mesh = *instance.mesh;
        Evaluated const e = std::move(evaluated[i]);
        std::size_t const first = instance.first_vertex, count = mesh.positions.size();
        for (std::size_t v = 0; v < count; ++v)
            world.positions[first + v] = vec3(e.vertices.positions[v] - world.origin);
        copy_or_fill(e.vertices.normals, world.normals, first, count, vec3{0});
        copy_or_fill(e.vertices.tangents, world.tangents, first, count, vec4{0});
        copy_or_fill(mesh.uv0, world.uv0, first, count, vec2{0});
        copy_or_fill(mesh.uv1, world.uv1, first, count, vec2{0});
        copy_or_fill(mesh.colors, world.colors, first, count, vec3{1});

        auto const material =
            mesh.material >= 0 ? std::uint32_t(mesh.material) : std::uint32_t(s.materials.size());
        std::uint64_t not_finite = 0, no_area = 0;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            uvec3 corner = mesh.triangles[t] + std::uint32_t(first);
            TriangleState state = e.states[t];
            if (state == TriangleState::good) // rounding to float may have taken its area
                state = judge(dvec3(world.positions[corner.x]), dvec3(world.positions[corner.y]),
                              dvec3(world.positions[corner.z]));
            not_finite += state == TriangleState::not_finite;
            no_area += state == TriangleState::no_area;
            if (state != TriangleState::good) continue;
            if (e.vertices.mirrored) std::swap(corner.y, corner.z);
            world.triangles.push_back(corner);
            world.triangle_material.push_back(material);
        }
        std::string const where = "mesh '" + mesh.name + "'";
        report.lose("triangles not finite or beyond 1e18 m, skipped", not_finite, where);
        report.lose("triangles without area, skipped", no_area, where);
    }
    build_surfaces(world);
    place_lights_and_cameras(world, pose, report);
    build_light_tables(world, report);
    report.count("triangles", double(world.triangles.size()));
    report.count("vertices", double(world.positions.size()));
    report.count("instances", double(world.instances));
    report.count("materials", double(s.materials.size()));
    report.count("textures", double(s.textures.textures.size()));
    report.count("punctual lights", double(world.lights.size()));
    return world;
}

WorldView view(World const& world)
{
    WorldView v;
    v.positions = world.positions;
    v.normals = world.normals;
    v.tangents = world.tangents;
    v.uv0 = world.uv0;
    v.uv1 = world.uv1;
    v.colors = world.colors;
    v.triangles = world.triangles;
    v.triangle_material = world.triangle_material;
    v.surfaces = world.surfaces;
    v.bsdfs = world.bsdfs;
    v.materials = world.materials;
    v.textures = view(world.scene->textures);
    v.lights = world.lights;
    v.emitters = world.emitters;
    v.emitter_pdf = world.emitter_pdf;
    v.light_select = view(world.light_select);
    v.environment_select = view(world.environment_select);
    if (auto const& map = world.scene->environment) {
        v.environment_radiance = map->radiance;
        v.environment_width = map->width;
        v.environment_height = map->height;
        v.environment_scale = map->scale;
        v.environment_cos = std::cos(map->rotation_rad);
        v.environment_sin = std::sin(map->rotation_rad);
    }
    v.environment_pdf = world.environment_pdf;
    v.scene_radius = world.bounds.radius();
    return v;
}

} // namespace gi
