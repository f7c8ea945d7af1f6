#include "gi/scene/motion/moving_world.h"

#include "gi/core/error.h"
#include "gi/scene/shading/bsdf.h"

#include <algorithm>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

bool finite(Light const& l)
{
    bool all = all_finite(l.position) && all_finite(l.direction) && all_finite(l.intensity);
    for (float const v : {l.cos_inner, l.cos_outer, l.range}) all &= std::isfinite(v);
    return all && glm::length(l.direction) > 0 &&
           glm::min(l.intensity.x, glm::min(l.intensity.y, l.intensity.z)) >= 0;
}

std::array<TextureRef, 7> textures_of(Material const& m)
{
    return {m.base_color_map, m.metallic_roughness_map, m.normal_map,      m.emissive_map,
            m.specular_map,   m.specular_color_map,     m.transmission_map};
}

bool emission_differs(Material const& a, Material const& b)
{
    return (emits(a) || emits(b)) &&
           (a.emission != b.emission || a.double_sided != b.double_sided || !(a.emissive_map == b.emissive_map));
}

bool coverage_differs(Material const& a, Material const& b)
{
    if (is_pane(a) != is_pane(b)) return true;
    if (a.alpha_mode == AlphaMode::opaque && b.alpha_mode == AlphaMode::opaque) return false;
    return a.alpha_mode != b.alpha_mode || a.alpha != b.alpha || a.alpha_cutoff != b.alpha_cutoff ||
           !(a.base_color_map == b.base_color_map);
}

bool same(AliasTable const& a, AliasTable const& b)
{
    return a.total == b.total &&
           std::ranges::equal(a.entries, b.entries, [](AliasEntry const& x, AliasEntry const& y) {
               return x.keep == y.keep && x.alias == y.alias && x.probability == y.probability;
           });
}

bool same(Bounds const& a, Bounds const& b) { return a.low == b.low && a.high == b.high; }

} // namespace

void Changes::add(Changes const& later)
{
    geometry |= later.geometry;
    bounds |= later.bounds;
    materials |= later.materials;
    coverage |= later.coverage;
    lights |= later.lights;
    emitters |= later.emitters;
    environment |= later.environment;
    light_select |= later.light_select;
    cameras |= later.cameras;
    moved_instances = std::max(moved_instances, later.moved_instances);
    moved_triangles = std::max(moved_triangles, later.moved_triangles);
    flat_triangles = later.flat_triangles;
    reasons.insert(reasons.end(), later.reasons.begin(), later.reasons.end());
}

MovingWorld::MovingWorld(std::shared_ptr<Scene const> scene, double time_s, Report& report,
                         std::optional<dvec3> origin)
    : parts_(build_world_parts(std::move(scene), time_s, report, origin)), next_(parts_.moving.size())
{
    Motion const motion = find_motion(*parts_.world.scene);
    for (LightPlace const& place : parts_.light_places) {
        light_moves_.push_back(!motion.node[place.node].empty());
        authored_.push_back(place.light.intensity);
    }
}

bool MovingWorld::only_cameras_move() const
{
    return parts_.moving.empty() && std::ranges::find(light_moves_, true) == light_moves_.end();
}

Changes MovingWorld::advance(double time_s) { return advance(evaluate_pose(*parts_.world.scene, time_s)); }

Changes MovingWorld::advance(Pose const& pose)
{
    World& world = parts_.world;
    Changes changes;
    move_instances(pose, changes);

    std::vector<Light> lights = world.lights;
    place_lights(parts_, pose, nullptr);
    changes.lights = lights != world.lights;
    if (changes.lights)
        changes.reasons.push_back(fmt::format("lights: {} of {} are at finite places, some moved",
                                              world.lights.size(), parts_.light_places.size()));
    std::vector<Camera> const cameras = world.cameras;
    place_cameras(world, pose, nullptr);
    changes.cameras = cameras != world.cameras;
    if (changes.cameras) changes.reasons.emplace_back("cameras: their nodes moved");

    bool const by_size = !world.environment_select.empty() ||
                         std::any_of(world.lights.begin(), world.lights.end(),
                                     [](Light const& l) { return l.type == LightType::directional; });
    if (changes.emitters || lights.size() != world.lights.size() || (changes.bounds && by_size))
        renew_light_select(changes);
    changes.flat_triangles = parts_.moving_extent.flat;
    return changes;
}

void MovingWorld::move_instances(Pose const& pose, Changes& changes)
{
    World& world = parts_.world;
    std::vector<Instance>& moving = parts_.moving;
    std::vector<std::uint8_t> moved(moving.size());
    tbb::parallel_for(std::size_t(0), moving.size(), [&](std::size_t i) {
        Instance& at = moving[i];
        place_instance(*world.scene, pose, at.node, *at.mesh, at.center, world.origin, next_[i]);
        moved[i] = !(next_[i] == at.placement);
        if (!moved[i]) return;
        std::swap(next_[i], at.placement);
        deform_into(world, at);
        write_moving_triangles(world, at);
        update_surfaces(world, at.first_triangle, at.first_triangle + at.mesh->triangles.size());
    });
    std::vector<std::string> why;
    for (std::size_t i = 0; i < moving.size(); ++i) {
        if (!moved[i]) continue;
        Instance const& at = moving[i];
        ++changes.moved_instances;
        changes.moved_triangles += std::uint32_t(at.mesh->triangles.size());
        if (std::find(why.begin(), why.end(), at.why_moving) == why.end()) why.push_back(at.why_moving);
        changes.emitters |=
            !at.mesh->triangles.empty() && emits(world.materials[world.triangle_material[at.first_triangle]]);
    }
    changes.geometry = changes.moved_instances > 0;
    if (!changes.geometry) return;
    changes.reasons.push_back(fmt::format("geometry: {} of {} moving instances, {} of {} triangles ({})",
                                          changes.moved_instances, moving.size(), changes.moved_triangles,
                                          world.triangles.size(), fmt::join(why, "; ")));
    parts_.moving_extent = measure_triangles(world, world.static_triangles, world.triangles.size());
    Bounds const bounds = joined(parts_.static_bounds, parts_.moving_extent.bounds);
    changes.bounds = !same(bounds, world.bounds);
    world.bounds = bounds;
    if (changes.emitters) {
        parts_.moving_emitters = {};
        add_emitters(world, world.static_triangles, world.triangles.size(), parts_.moving_emitters);
        changes.reasons.emplace_back("emitters: triangles that emit moved");
    }
}

void MovingWorld::renew_emitters(Changes& changes)
{
    World const& world = parts_.world;
    parts_.static_emitters = {};
    parts_.moving_emitters = {};
    add_emitters(world, 0, world.static_triangles, parts_.static_emitters);
    add_emitters(world, world.static_triangles, world.triangles.size(), parts_.moving_emitters);
    changes.emitters = true;
}

void MovingWorld::renew_light_select(Changes& changes)
{
    World& world = parts_.world;
    auto const emitters = world.emitters;
    auto const emitter_pdf = world.emitter_pdf;
    AliasTable const select = world.light_select;
    float const environment_pdf = world.environment_pdf;
    build_light_select(world, parts_.static_emitters, parts_.moving_emitters);
    changes.light_select |= !same(select, world.light_select) || environment_pdf != world.environment_pdf ||
                            emitters != world.emitters || emitter_pdf != world.emitter_pdf;
}

Changes MovingWorld::set_light(std::size_t k, Light const& light)
{
    World& world = parts_.world;
    if (k >= world.lights.size())
        throw InputError(fmt::format("there is no light {}", k),
                         fmt::format("the world has {}, counted from 0", world.lights.size()),
                         "choose one of them");
    if (!finite(light))
        throw InputError(fmt::format("light {} cannot be set", k),
                         "a value is not finite, its intensity is negative or its direction is zero",
                         "give finite values");
    Changes changes;
    Light given = light;
    given.direction = glm::normalize(light.direction);
    if (light.direction == world.lights[k].direction) given.direction = light.direction;
    std::uint32_t const at = parts_.light_place[k];
    if (given == world.lights[k]) return changes;
    LightPlace& place = parts_.light_places[at];
    if (!light_moves_[at])
        place.free |= given.position != world.lights[k].position || given.direction != world.lights[k].direction;
    place.light = given;
    world.lights[k] = given;
    changes.lights = true;
    renew_light_select(changes);
    changes.reasons.push_back(fmt::format("lights: light {} was set", k));
    return changes;
}

Changes MovingWorld::set_material(std::size_t k, Material const& material)
{
    World& world = parts_.world;
    if (k >= world.materials.size())
        throw InputError(
            fmt::format("there is no material {}", k),
            fmt::format("the world has {}, counted from 0, the default one last", world.materials.size()),
            "choose one of them");
    for (TextureRef const& t : textures_of(material))
        if (t.uv_set > 1 || t.texture >= std::int32_t(world.scene->textures.textures.size()))
            throw InputError(
                fmt::format("material {} cannot be set", k),
                fmt::format("it refers to texture {} of {}", t.texture, world.scene->textures.textures.size()),
                "use textures that the scene has");
    Changes changes;
    Material const before = world.materials[k];
    if (before == material) return changes;
    world.materials[k] = material;
    world.bsdfs[k] = make_bsdf(material);
    changes.materials = true;
    changes.coverage = coverage_differs(before, material);
    if (has_textures(before) != has_textures(material) || emits(before) != emits(material) ||
        before.double_sided != material.double_sided || before.alpha_mode != material.alpha_mode)
        update_surfaces_of(world, std::uint32_t(k));
    changes.reasons.push_back(fmt::format("materials: material {} was set", k));
    if (emission_differs(before, material)) {
        renew_emitters(changes);
        renew_light_select(changes);
        changes.reasons.push_back(fmt::format("emitters: the emission of material {} was set", k));
    }
    return changes;
}

void MovingWorld::check_environment(vec3 scale) const
{
    if (all_finite(scale) && glm::min(scale.x, glm::min(scale.y, scale.z)) >= 0) return;
    throw InputError("the environment map cannot be set", "its scale is negative or not finite",
                     "give a finite scale of 0 or more");
}

Changes MovingWorld::set_environment(std::shared_ptr<EnvironmentMap const> map)
{
    World& world = parts_.world;
    if (map) {
        check_environment(map->scale);
        if (map->width == 0 || map->height == 0 || map->radiance.size() != std::size_t(map->width) * map->height ||
            !std::isfinite(map->rotation_rad))
            throw InputError("the environment map cannot be set",
                             fmt::format("{} x {} texels are {} values, or its rotation is not finite", map->width,
                                         map->height, map->radiance.size()),
                             "give a map with width * height texels");
    }
    Changes changes;
    if (!map && !world.environment) return changes;
    world.environment = std::move(map);
    world.environment_rotation_rad = world.environment ? world.environment->rotation_rad : 0;
    world.environment_scale = world.environment ? world.environment->scale : vec3{1};
    build_environment_table(world);
    changes.environment = true;
    renew_light_select(changes);
    changes.reasons.emplace_back("environment: the map was set");
    return changes;
}

Changes MovingWorld::turn_environment(float rotation_rad, vec3 scale)
{
    World& world = parts_.world;
    check_environment(scale);
    if (!std::isfinite(rotation_rad))
        throw InputError("the environment map cannot be turned", "the angle is not finite", "give a finite angle");
    Changes changes;
    bool const rescaled = scale != world.environment_scale;
    if (!world.environment || (!rescaled && rotation_rad == world.environment_rotation_rad)) return changes;
    world.environment_rotation_rad = rotation_rad;
    world.environment_scale = scale;
    changes.environment = true;
    if (rescaled) {
        build_environment_table(world);
        renew_light_select(changes);
    }
    changes.reasons.emplace_back(rescaled ? "environment: scaled" : "environment: turned");
    return changes;
}

} // namespace gi
