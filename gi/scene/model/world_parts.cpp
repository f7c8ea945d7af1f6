#include "gi/scene/model/world_parts.h"

#include "gi/core/huge_pages.h"
#include "gi/core/step.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Bounds of all usable triangle corners.
Bounds corner_bounds(World const& world, std::vector<Instance> const& instances)
{
    constexpr float kFarthest = 1e18f;
    Bounds b;
    for (Instance const& i : instances)
        for (uvec3 const t : i.mesh->triangles)
            for (int k = 0; k < 3; ++k) {
                vec3 const p = world.positions[i.first_vertex + t[k]];
                if (!all_finite(p) || max_component(glm::abs(p)) > kFarthest) continue;
                b.low = glm::min(b.low, p);
                b.high = glm::max(b.high, p);
            }
    return b;
}

void place_and_deform(World& world, Pose const& pose, std::vector<Instance>& instances)
{
    tbb::parallel_for(std::size_t(0), instances.size(), [&](std::size_t i) {
        Instance& at = instances[i];
        place_instance(*world.scene, pose, at.node, *at.mesh, at.center, world.origin, at.placement);
        deform_into(world, at);
    });
}

/// Chooses the origin. The centre of a distant scene is refined iteratively, since floats are imprecise there.
void choose_origin(World& world, Pose const& pose, std::vector<Instance>& instances)
{
    for (int look = 0; look < 4; ++look) {
        Bounds const b = corner_bounds(world, instances);
        if (b.empty()) return;
        double const size = glm::length(dvec3(b.high) - dvec3(b.low));
        dvec3 const center = world.origin + 0.5 * (dvec3(b.low) + dvec3(b.high));
        bool const far = world.origin != dvec3{0} || glm::length(center) > 500 * size;
        if (!far || glm::length(center - world.origin) <= 1e-4 * size) return;
        world.origin = center;
        place_and_deform(world, pose, instances);
    }
}

dvec3 back_axis(dmat4 const& m)
{
    dvec3 const back(m[2]);
    return glm::length(back) > 0 ? glm::normalize(back) : dvec3{0, 0, 1};
}

} // namespace

void place_lights(WorldParts& parts, Pose const& pose, Report* report)
{
    World& world = parts.world;
    world.lights.clear();
    parts.light_place.clear();
    for (std::size_t i = 0; i < parts.light_places.size(); ++i) {
        LightPlace const& place = parts.light_places[i];
        Light light = place.light;
        if (!place.free) {
            dmat4 const& m = pose.world_from_node[place.node];
            light.position = vec3(dvec3(m[3]) - world.origin);
            light.direction = vec3(-back_axis(m));
        }
        if (all_finite(light.position) && all_finite(light.direction)) {
            world.lights.push_back(light);
            parts.light_place.push_back(std::uint32_t(i));
        } else if (report != nullptr) {
            report->lose("lights not at a finite place, skipped", 1,
                         "node '" + world.scene->nodes[place.node].name + "'");
        }
    }
}

void place_cameras(World& world, Pose const& pose, Report* report)
{
    Scene const& scene = *world.scene;
    world.cameras.clear();
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        Node const& node = scene.nodes[n];
        if (node.camera < 0) continue;
        dmat4 const& m = pose.world_from_node[n];
        dvec3 const z = back_axis(m);
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
        else if (report != nullptr)
            report->lose("cameras not at a finite place, skipped", 1, "node '" + node.name + "'");
    }
}

WorldParts build_world_parts(std::shared_ptr<Scene const> scene, SceneTime time_s, Report& report,
                             std::optional<dvec3> origin)
{
    WorldParts parts;
    World& world = parts.world;
    world.scene = std::move(scene);
    Scene const& s = *world.scene;
    world.materials = s.materials;
    world.materials.push_back({});
    if (s.environment) {
        world.environment = {world.scene, &*s.environment};
        world.environment_rotation_rad = s.environment->rotation_rad;
        world.environment_scale = s.environment->scale;
    }
    Pose const pose = evaluate_pose(s, time_s);
    std::vector<Instance> instances = find_instances(s);
    prepare_vertices(world, instances);
    if (origin) world.origin = *origin;
    place_and_deform(world, pose, instances);
    if (!origin) choose_origin(world, pose, instances);

    std::uint64_t unusable = 0;
    for (std::size_t done = 0; Instance & i : instances) {
        at_step("world", done++, instances.size());
        world.placed.push_back({std::uint32_t(i.node), std::uint32_t(world.triangles.size())});
        if (!i.moves()) {
            append_static_triangles(world, i, report);
            continue;
        }
        append_moving_triangles(world, i);
        write_moving_triangles(world, i);
        unusable += i.unusable_vertices;
        parts.moving.push_back(std::move(i));
    }
    if (unusable > 0)
        report.lose("vertices of moving meshes not finite or beyond 1e18 m, their triangles left out", unusable);

    std::size_t const fixed = world.static_triangles, all = world.triangles.size();
    parts.static_bounds = measure_triangles(world, 0, fixed).bounds;
    parts.moving_extent = measure_triangles(world, fixed, all);
    world.bounds = joined(parts.static_bounds, parts.moving_extent.bounds);
    build_bsdfs(world);
    resize_on_huge_pages(world.surfaces, all);
    update_surfaces(world, 0, all);

    for (std::size_t n = 0; n < s.nodes.size(); ++n)
        if (std::int32_t const l = s.nodes[n].light; l >= 0)
            parts.light_places.push_back({n, s.lights[std::size_t(l)], false});
    place_lights(parts, pose, &report);
    place_cameras(world, pose, &report);
    build_environment_table(world);
    add_emitters(world, 0, fixed, parts.static_emitters);
    add_emitters(world, fixed, all, parts.moving_emitters);
    build_light_select(world, parts.static_emitters, parts.moving_emitters);

    report.count("triangles", double(all));
    report.count("vertices", double(world.positions.size()));
    report.count("instances", double(world.instances));
    report.count("materials", double(s.materials.size()));
    report.count("textures", double(s.textures.textures.size()));
    report.count("punctual lights", double(world.lights.size()));
    report.count("emissive triangles", double(world.emitters.size()));
    if (all > fixed) {
        report.count("triangles that can move", double(all - fixed));
        report.count("dynamic triangles without area", double(parts.moving_extent.flat));
    }
    return parts;
}

} // namespace gi
