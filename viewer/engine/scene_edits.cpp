#include "viewer/engine/scene_edits.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/core/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numeric>

namespace viewer {
namespace {

constexpr double kFarthest_m = 1e7, kBrightest = 1e12;

constexpr SceneEditKey kKeys[]{
    {"object", "position", "NODE", 3, false, -kFarthest_m, kFarthest_m, "place of an object, m, world"},
    {"object", "rotation", "NODE", 4, false, -1, 1, "rotation of an object, quaternion x, y, z, w"},
    {"object", "scale", "NODE", 1, false, 1e-6, 1e6, "size of an object over that of its model"},
    {"light", "intensity", "N", 3, true, 0, kBrightest,
     "intensity of a light: W/sr per channel of a point or spot light, W/m2 of a directional one"},
    {"light", "scale", "N", 1, false, 0, 1e9, "factor on the intensity that the scene gives a light"},
    {"light", "position", "N", 3, false, -kFarthest_m, kFarthest_m, "place of a light, m, world"},
    {"material", "base_color", "NAME", 3, true, 0, 1, "albedo of a material, per channel"},
    {"material", "roughness", "NAME", 1, false, 0, 1, "roughness of a material"},
    {"material", "metallic", "NAME", 1, false, 0, 1, "share of metal of a material"},
    {"material", "emission", "NAME", 3, true, 0, kBrightest, "radiance that a material emits, per channel"},
    {"material", "emission_scale", "NAME", 1, false, 0, 1e9,
     "factor on the radiance that the scene lets a material emit"},
    {"environment", "rotation", "", 1, false, -1e6, 1e6, "rotation of the environment map, rad"},
    {"environment", "scale", "", 1, false, 0, 1e9, "factor on the radiance of the environment map"},
};

[[noreturn]] void refuse(Change const& c, std::string const& why, std::string const& suggestion)
{
    throw gi::InputError(fmt::format("'{}' = {}", c.key, c.value.dump()), why, suggestion);
}

double number(Change const& c, nlohmann::json const& v, SceneEditKey const& k)
{
    double const x = v.is_number() ? v.get<double>() : std::nan("");
    if (!(x >= k.low && x <= k.high))
        refuse(c, fmt::format("it takes numbers from {:g} to {:g}", k.low, k.high), "set one in this range");
    return x;
}

/// The numbers of the value, of which the first `count` count.
std::array<double, 4> numbers(Change const& c, SceneEditKey const& k)
{
    std::array<double, 4> out{};
    if (k.count == 1 || (k.or_one && !c.value.is_array())) {
        out.fill(number(c, c.value, k));
        return out;
    }
    if (!c.value.is_array() || c.value.size() != std::size_t(k.count))
        refuse(c, fmt::format("it takes {} numbers{}", k.count, k.or_one ? ", or one for all" : ""),
               "set a list of numbers");
    for (std::size_t i = 0; i < std::size_t(k.count); ++i) out[i] = number(c, c.value[i], k);
    return out;
}

gi::dvec3 vector(Change const& c, SceneEditKey const& k)
{
    auto const v = numbers(c, k);
    return {v[0], v[1], v[2]};
}

double number(Change const& c, SceneEditKey const& k) { return numbers(c, k)[0]; }

/// Splits "object.left.hand.position" into object, left.hand, position.
struct Key {
    std::string kind, name, what;
};

Key parse(std::string const& key)
{
    std::size_t const first = key.find('.'), last = key.rfind('.');
    if (first == std::string::npos) return {key, "", ""};
    if (first == last) return {key.substr(0, first), "", key.substr(last + 1)};
    return {key.substr(0, first), key.substr(first + 1, last - first - 1), key.substr(last + 1)};
}

/// Index of an item given by its name or number. @param name_of  returns the name at an index
template <class NameOf>
std::size_t find(Change const& c, std::string const& name, std::size_t count, NameOf const& name_of)
{
    for (std::size_t i = 0; i < count; ++i)
        if (!name.empty() && name_of(i) == name) return i;
    if (auto const index = gi::parse_number<std::size_t>(name); index && *index < count) return *index;
    std::vector<std::string> known;
    for (std::size_t i = 0; i < count; ++i)
        if (std::string one = name_of(i); !one.empty()) known.push_back(std::move(one));
    std::string const of_number =
        count > 0 ? fmt::format("give a number from 0 to {}", count - 1) : "leave it out";
    refuse(c, fmt::format("there are {}, and none is called '{}'", count, name),
           known.empty() ? of_number : fmt::format("{}, or a name: {}", of_number, gi::suggest(name, known)));
}

std::vector<std::size_t> edited_lights(Change const& c, Key const& key, std::size_t count)
{
    if (key.name != "all") return {find(c, key.name, count, [](std::size_t) { return std::string(); })};
    if (count == 0) refuse(c, "the scene has no light", "change the emission of a material, or the environment");
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), std::size_t(0));
    return all;
}

/// @param authored  its intensity in the scene  @param origin  of the world
gi::Light edited(gi::Light light, Change const& c, Key const& key, gi::vec3 authored, gi::dvec3 origin)
{
    SceneEditKey const& facts = find_scene_edit(c.key);
    if (key.what == "intensity")
        light.intensity = gi::vec3(vector(c, facts));
    else if (key.what == "scale")
        light.intensity = float(number(c, facts)) * authored;
    else
        light.position = gi::vec3(vector(c, facts) - origin);
    return light;
}

gi::Changes edit_lights(gi::MovingWorld& world, Change const& c, Key const& key)
{
    std::vector<gi::Light> const& lights = world.world().lights;
    gi::Changes changes;
    for (std::size_t const k : edited_lights(c, key, lights.size()))
        changes.add(
            world.set_light(k, edited(lights[k], c, key, world.authored_intensity(k), world.world().origin)));
    return changes;
}

gi::Changes edit_material(gi::MovingWorld& world, Change const& c, Key const& key)
{
    SceneEditKey const& facts = find_scene_edit(c.key);
    gi::Scene const& scene = *world.world().scene;
    std::size_t const k = find(c, key.name, world.world().materials.size(), [&](std::size_t i) {
        return i < scene.material_names.size() ? scene.material_names[i] : "default";
    });
    gi::Material m = world.world().materials[k];
    if (key.what == "base_color")
        m.base_color = gi::vec3(vector(c, facts));
    else if (key.what == "emission")
        m.emission = gi::vec3(vector(c, facts));
    else if (key.what == "emission_scale")
        m.emission =
            k < scene.materials.size() ? float(number(c, facts)) * scene.materials[k].emission : gi::vec3(0);
    else if (key.what == "roughness")
        m.roughness = float(number(c, facts));
    else
        m.metallic = float(number(c, facts));
    return world.set_material(k, m);
}

gi::Changes edit_environment(gi::MovingWorld& world, Change const& c, Key const& key)
{
    SceneEditKey const& facts = find_scene_edit(c.key);
    gi::World const& w = world.world();
    if (!w.environment) refuse(c, "the scene has no environment map", "load a scene that has one");
    if (key.what == "rotation") return world.turn_environment(float(number(c, facts)), w.environment_scale);
    return world.turn_environment(w.environment_rotation_rad, gi::vec3(float(number(c, facts))));
}

} // namespace

std::span<SceneEditKey const> scene_edit_keys() { return kKeys; }

std::string pattern_of(SceneEditKey const& k)
{
    return fmt::format("{}.{}{}{}", k.kind, k.name, k.name.empty() ? "" : ".", k.what);
}

SceneEditKey const& find_scene_edit(std::string const& text)
{
    Key const key = parse(text);
    std::vector<std::string> known;
    bool needs_name = false;
    for (SceneEditKey const& k : kKeys) {
        if (k.kind != key.kind) continue;
        if (k.what == key.what && k.name.empty() == key.name.empty()) return k;
        known.emplace_back(k.what);
        needs_name = !k.name.empty();
    }
    if (needs_name && key.name.empty())
        throw gi::InputError(
            "'" + text + "'", "it does not say which one",
            fmt::format("write {}.{}.{}", key.kind, key.kind == "light" ? "0" : "NAME", known[0]));
    throw gi::InputError(fmt::format("'{}' has no property '{}'", key.kind, key.what),
                         "there is none of that name", gi::suggest(key.what, known));
}

void check_scene_edit(Change const& c) { numbers(c, find_scene_edit(c.key)); }

bool is_object_edit(std::string const& key) { return key.starts_with("object."); }
bool is_light_edit(std::string const& key) { return key.starts_with("light."); }

bool is_scene_edit(std::string const& key)
{
    return is_object_edit(key) || is_light_edit(key) || key.starts_with("material.") ||
           key.starts_with("environment.");
}

gi::Changes edit(gi::MovingWorld& world, Change const& c)
{
    Key const key = parse(c.key);
    if (key.kind == "light") return edit_lights(world, c, key);
    if (key.kind == "material") return edit_material(world, c, key);
    return edit_environment(world, c, key);
}

void edit_lights(std::vector<gi::Light>& lights, Change const& c, std::span<gi::vec3 const> authored,
                 gi::dvec3 origin)
{
    Key const key = parse(c.key);
    for (std::size_t const k : edited_lights(c, key, lights.size()))
        lights[k] = edited(lights[k], c, key, authored[k], origin);
}

PlacedObject placed_object(gi::Scene const& scene, gi::Pose const& now, std::vector<PlacedObject> const& placed,
                           Change const& c)
{
    SceneEditKey const& facts = find_scene_edit(c.key);
    Key const key = parse(c.key);
    std::size_t const node =
        find(c, key.name, scene.nodes.size(), [&](std::size_t i) { return scene.nodes[i].name; });
    PlacedObject object{node};
    auto const before =
        std::find_if(placed.begin(), placed.end(), [&](PlacedObject const& p) { return p.node == node; });
    if (before != placed.end()) {
        object = *before;
    } else {
        gi::dmat4 const& m = now.world_from_node[node];
        object.position = gi::dvec3(m[3]);
        object.scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(m))));
        if (object.scale > 0 && std::isfinite(object.scale))
            object.rotation = glm::normalize(glm::quat_cast(glm::dmat3(m) / object.scale));
        else
            object.scale = 1;
    }
    if (key.what == "position") {
        object.position = vector(c, facts);
    } else if (key.what == "rotation") {
        auto const q = numbers(c, facts);
        gi::dquat rotation;
        rotation.x = q[0];
        rotation.y = q[1];
        rotation.z = q[2];
        rotation.w = q[3];
        if (!(glm::length(rotation) > 1e-3)) refuse(c, "it is no rotation", "give a unit quaternion x, y, z, w");
        object.rotation = glm::normalize(rotation);
    } else {
        object.scale = number(c, facts);
    }
    return object;
}

void place(gi::Scene const& scene, std::vector<PlacedObject> const& placed, gi::Pose& pose)
{
    for (PlacedObject const& object : placed) {
        gi::dmat4 const old = pose.world_from_node[object.node];
        gi::dmat4 const now = glm::translate(gi::dmat4(1), object.position) * glm::mat4_cast(object.rotation) *
                              glm::scale(gi::dmat4(1), gi::dvec3(object.scale));
        gi::dmat4 const change = now * glm::inverse(old);
        // Parents come before their children.
        std::vector<bool> below(scene.nodes.size(), false);
        for (std::size_t n = object.node; n < scene.nodes.size(); ++n) {
            std::int32_t const parent = scene.nodes[n].parent;
            below[n] = n == object.node || (parent >= 0 && below[std::size_t(parent)]);
            if (below[n]) pose.world_from_node[n] = n == object.node ? now : change * pose.world_from_node[n];
        }
    }
}

} // namespace viewer
