#include "gi/scene/load/scene_file_keys.h"
#include "gi/scene/load/scene_file_parts.h"

#include <fmt/format.h>

namespace gi {
namespace {

/// Returns the unit direction; downwards by default.
dvec3 read_direction(Yaml const& l, dvec3 position)
{
    if (l.has("direction") && l.has("target"))
        throw l.error("a light has both direction and target", "they contradict each other", "keep one");
    dvec3 direction{0, -1, 0};
    if (l.has("direction")) direction = l.at("direction").vector();
    if (l.has("target")) direction = l.at("target").vector() - position;
    double const length = glm::length(direction);
    if (!(length > 0)) throw l.error("the light has no direction", "the vector is zero", "direction: [0, -1, 0]");
    return direction / length;
}

struct Rectangle {
    dvec3 corner, u, v;
};

/// Reads a rectangle from its corner and edges, or from its centre, size and direction
/// (then the first edge is horizontal).
Rectangle read_rectangle(Yaml const& l)
{
    auto const need = [&](char const* key) {
        if (!l.has(key))
            throw l.error(
                fmt::format("a rectangle light needs {}", key),
                "a rectangle has corner and edges (position, u, v) or centre and size (position, size, direction)",
                "position: [0, 2, 0], u: [1, 0, 0], v: [0, 0, 1], radiance: 10");
    };
    need("position");
    need("radiance");
    dvec3 const position = l.at("position").vector();
    if (!l.has("size")) {
        need("u");
        need("v");
        if (l.has("direction") || l.has("target"))
            throw l.error("a rectangle with u and v has no direction", "it shines along u x v",
                          "give size instead");
        return {position, l.at("u").vector(), l.at("v").vector()};
    }
    if (l.has("u") || l.has("v"))
        throw l.error("a rectangle has both size and edges", "they contradict each other", "keep one");
    auto const size = l.at("size").items();
    if (size.size() != 2)
        throw l.at("size").error("a size needs two numbers", "width and height, m", "size: [1, 0.5]");
    double const width = size[0].number(1e-9, 1e9), height = size[1].number(1e-9, 1e9);
    dvec3 const n = read_direction(l, position);
    dvec3 const up = std::abs(n.y) < 0.999 ? dvec3{0, 1, 0} : dvec3{0, 0, 1};
    dvec3 const u = width * glm::normalize(glm::cross(up, n)), v = height * glm::normalize(glm::cross(n, u));
    return {position - 0.5 * (u + v), u, v};
}

/// Adds an emissive quad that shines in the direction of u x v.
void add_rectangle(Yaml const& l, Scene& scene)
{
    check_keys(l, "rectangle_light");
    auto const [corner, u, v] = read_rectangle(l);
    if (!(glm::length(glm::cross(u, v)) > 0))
        throw l.error("the rectangle has no area", "u and v are parallel or zero", "give two different edges");
    Material m;
    m.base_color = vec3{0};
    m.specular = 0;
    m.emission = vec3(l.at("radiance").vector_or_number(0, 1e12));
    Mesh mesh;
    mesh.name = "rectangle light";
    mesh.material = std::int32_t(scene.materials.size());
    mesh.positions = {vec3{0}, vec3(u), vec3(u + v), vec3(v)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    Node node;
    node.name = mesh.name;
    node.translation = corner;
    node.meshes = {std::int32_t(scene.meshes.size())};
    scene.materials.push_back(m);
    scene.material_names.push_back(mesh.name);
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(std::move(node));
}

} // namespace

void add_scene_file_light(Yaml const& l, Scene& scene)
{
    if (!l.is_map() || !l.has("type"))
        throw l.error("a light needs a type", "the key type is missing", "type: point");
    std::string const type = l.at("type").text();
    if (type == "rectangle") return add_rectangle(l, scene);
    Light light;
    if (type == "point") {
        check_keys(l, "point_light");
        light.type = LightType::point;
    } else if (type == "spot") {
        check_keys(l, "spot_light");
        light.type = LightType::spot;
    } else if (type == "directional") {
        check_keys(l, "directional_light");
        light.type = LightType::directional;
    } else {
        throw l.at("type").error("there is no light type '" + type.substr(0, 64) + "'", "the type is unknown",
                                 "choose point, spot, directional or rectangle");
    }
    dvec3 const position = l.has("position") ? l.at("position").vector() : dvec3{0};
    dvec3 const direction = read_direction(l, position);
    if (l.has("intensity")) light.intensity = vec3(l.at("intensity").vector_or_number(0, 1e12));
    if (l.has("range")) light.range = float(l.at("range").number(0, 1e12));
    if (l.has("cone")) {
        auto const angles = l.at("cone").items();
        if (angles.size() != 2)
            throw l.at("cone").error("a cone needs two angles", "inner and outer, degrees", "cone: [20, 30]");
        double const outer = angles[1].number(0.01, 90), inner = angles[0].number(0, outer);
        light.cos_inner = float(std::cos(glm::radians(inner)));
        light.cos_outer = float(std::cos(glm::radians(outer)));
    }
    Node node;
    node.name = type + " light";
    node.light = std::int32_t(scene.lights.size());
    dvec3 const z = -direction;
    Frame const frame = Frame::about(vec3(z));
    node.matrix = dmat4(glm::dvec4(dvec3(frame.tangent), 0), glm::dvec4(dvec3(frame.bitangent), 0),
                        glm::dvec4(z, 0), glm::dvec4(position, 1));
    scene.lights.push_back(light);
    scene.nodes.push_back(std::move(node));
}

} // namespace gi
