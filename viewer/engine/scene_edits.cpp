#include "viewer/engine/scene_edits.h"

#include "gi/core/error.h"
#include "gi/core/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace viewer {
namespace {

constexpr double kFarthest_m = 1e7, kBrightest = 1e12;

[[noreturn]] void refuse(Change const& c, std::string const& why, std::string const& suggestion)
{
    throw gi::InputError(fmt::format("'{}' = {}", c.key, c.value.dump()), why, suggestion);
}

double number(Change const& c, nlohmann::json const& v, double low, double high)
{
    double const x = v.is_number() ? v.get<double>() : std::nan("");
    if (!(x >= low && x <= high))
        refuse(c, fmt::format("it takes numbers from {:g} to {:g}", low, high), "set one in this range");
    return x;
}

template <std::size_t N>
std::array<double, N> numbers(Change const& c, double low, double high)
{
    if (!c.value.is_array() || c.value.size() != N)
        refuse(c, fmt::format("it takes {} numbers", N), "set a list of numbers");
    std::array<double, N> out{};
    for (std::size_t i = 0; i < N; ++i) out[i] = number(c, c.value[i], low, high);
    return out;
}

gi::dvec3 vector(Change const& c, double low, double high)
{
    auto const v = numbers<3>(c, low, high);
    return {v[0], v[1], v[2]};
}

/// Splits "object.left.hand.position" into object, left.hand, position.
struct Key {
    std::string kind, name, what;
};

Key parse(Change const& c)
{
    std::size_t const first = c.key.find('.'), last = c.key.rfind('.');
    if (first == std::string::npos) refuse(c, "the key names nothing in the scene", "see docs/viewer.md");
    if (first == last) return {c.key.substr(0, first), "", c.key.substr(last + 1)};
    return {c.key.substr(0, first), c.key.substr(first + 1, last - first - 1), c.key.substr(last + 1)};
}

/// Index of an item given by its name or number. @param name_of  returns the name at an index
template <class NameOf>
std::size_t find(Change const& c, std::string const& name, std::size_t count, NameOf const& name_of)
{
    for (std::size_t i = 0; i < count; ++i)
        if (!name.empty() && name_of(i) == name) return i;
    if (auto const index = gi::parse_number<std::size_t>(name); index && *index < count) return *index;
    refuse(c, fmt::format("there are {}, and none is called '{}'", count, name),
           "give a name, or a number from 0");
}

gi::Changes edit_light(gi::MovingWorld& world, Change const& c, Key const& key)
{
    auto const& lights = world.world().lights;
    std::size_t const k = find(c, key.name, lights.size(), [](std::size_t) { return std::string(); });
    gi::Light light = lights[k];
    if (key.what == "intensity")
        light.intensity = gi::vec3(vector(c, 0, kBrightest));
    else if (key.what == "position")
        light.position = gi::vec3(vector(c, -kFarthest_m, kFarthest_m) - world.world().origin);
    else
        refuse(c, "a light has no such property", "set intensity or position");
    return world.set_light(k, light);
}

gi::Changes edit_material(gi::MovingWorld& world, Change const& c, Key const& key)
{
    auto const& names = world.world().scene->material_names;
    std::size_t const k = find(c, key.name, world.world().materials.size(),
                               [&](std::size_t i) { return i < names.size() ? names[i] : "default"; });
    gi::Material m = world.world().materials[k];
    if (key.what == "base_color")
        m.base_color = gi::vec3(vector(c, 0, 1));
    else if (key.what == "emission")
        m.emission = gi::vec3(vector(c, 0, kBrightest));
    else if (key.what == "roughness")
        m.roughness = float(number(c, c.value, 0, 1));
    else if (key.what == "metallic")
        m.metallic = float(number(c, c.value, 0, 1));
    else
        refuse(c, "a material has no such property", "set base_color, emission, roughness or metallic");
    return world.set_material(k, m);
}

gi::Changes edit_environment(gi::MovingWorld& world, Change const& c, Key const& key)
{
    gi::World const& w = world.world();
    if (!w.environment) refuse(c, "the scene has no environment map", "load a scene that has one");
    if (key.what == "rotation")
        return world.turn_environment(float(number(c, c.value, -1e6, 1e6)), w.environment_scale);
    if (key.what == "scale")
        return world.turn_environment(w.environment_rotation_rad, gi::vec3(float(number(c, c.value, 0, 1e9))));
    refuse(c, "an environment map has no such property", "set rotation or scale");
}

} // namespace

bool is_object_edit(std::string const& key) { return key.starts_with("object."); }

bool is_scene_edit(std::string const& key)
{
    return is_object_edit(key) || key.starts_with("light.") || key.starts_with("material.") ||
           key.starts_with("environment.");
}

gi::Changes edit(gi::MovingWorld& world, Change const& c)
{
    Key const key = parse(c);
    if (key.kind == "light") return edit_light(world, c, key);
    if (key.kind == "material") return edit_material(world, c, key);
    return edit_environment(world, c, key);
}

PlacedObject placed_object(gi::Scene const& scene, gi::Pose const& now, std::vector<PlacedObject> const& placed,
                           Change const& c)
{
    Key const key = parse(c);
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
        object.position = vector(c, -kFarthest_m, kFarthest_m);
    } else if (key.what == "rotation") {
        auto const q = numbers<4>(c, -1, 1);
        gi::dquat rotation;
        rotation.x = q[0];
        rotation.y = q[1];
        rotation.z = q[2];
        rotation.w = q[3];
        if (!(glm::length(rotation) > 1e-3)) refuse(c, "it is no rotation", "give a unit quaternion x, y, z, w");
        object.rotation = glm::normalize(rotation);
    } else if (key.what == "scale") {
        object.scale = number(c, c.value, 1e-6, 1e6);
    } else {
        refuse(c, "an object has no such property", "set position, rotation or scale");
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
