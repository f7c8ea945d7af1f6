#include "viewer/offline/scene_light.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace viewer {
namespace {

constexpr gi::vec3 kBehind{0.2f}; ///< radiance: white and black models stand out from it

enum class LightKind { none, glows, lights };

/// Of the nodes' meshes and lights.
LightKind light_of(gi::Scene const& scene)
{
    bool glows = false;
    for (gi::Node const& node : scene.nodes) {
        if (node.light >= 0 && gi::max_component(scene.lights[std::size_t(node.light)].intensity) > 0)
            return LightKind::lights;
        for (std::int32_t const mesh : node.meshes) {
            std::int32_t const index = scene.meshes[std::size_t(mesh)].material;
            if (index < 0) continue;
            gi::Material const& m = scene.materials[std::size_t(index)];
            if (!gi::emits(m)) continue;
            if (m.emissive_map.texture < 0 || gi::max_component(m.emission) > 1) return LightKind::lights;
            glows = true;
        }
    }
    return glows ? LightKind::glows : LightKind::none;
}

/// True if all that the nodes show is to be seen in its base colours.
bool is_unlit(gi::Scene const& scene)
{
    bool is_any = false;
    for (gi::Node const& node : scene.nodes)
        for (std::int32_t const mesh : node.meshes) {
            std::int32_t const index = scene.meshes[std::size_t(mesh)].material;
            if (index < 0 || !scene.materials[std::size_t(index)].unlit) return false;
            is_any = true;
        }
    return is_any;
}

/// 1 within a lamp, 0 beyond its soft border.
float within(gi::vec3 direction, gi::vec3 to_lamp, float radius_deg)
{
    constexpr float kBorder = 0.35f; // of the radius
    float const angle = glm::degrees(std::acos(glm::clamp(glm::dot(direction, to_lamp), -1.0f, 1.0f)));
    return 1 - glm::smoothstep((1 - kBorder) * radius_deg, (1 + kBorder) * radius_deg, angle);
}

/// Of a place in a lat-long map, 0..1 from its top left corner (docs/methods/scene.md).
gi::vec3 direction_of(double x, double y)
{
    double const azimuth = gi::kPiD * (2 * x - 1), polar = gi::kPiD * y;
    return gi::vec3(
        gi::dvec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)));
}

/// Radiance of a white diffuse surface that faces most light.
float most_reflected(gi::EnvironmentMap const& map)
{
    constexpr int kNormals = 24; // rows of normals; twice as many in each
    std::vector<gi::vec3> towards;
    std::vector<float> arriving; // radiance times solid angle, over pi
    for (std::uint32_t y = 0; y < map.height; ++y) {
        double const row = (y + 0.5) / map.height,
                     share = 2 * gi::kPiD / map.width / map.height * std::sin(gi::kPiD * row);
        for (std::uint32_t x = 0; x < map.width; ++x) {
            towards.push_back(direction_of((x + 0.5) / map.width, row));
            arriving.push_back(float(share) * map.radiance[std::size_t(y) * map.width + x].x);
        }
    }
    float most = 0;
    for (int j = 0; j < kNormals; ++j)
        for (int i = 0; i < 2 * kNormals; ++i) {
            gi::vec3 const normal = direction_of((i + 0.5) / (2 * kNormals), (j + 0.5) / kNormals);
            float sum = 0;
            for (std::size_t k = 0; k < towards.size(); ++k)
                sum += arriving[k] * std::max(0.0f, glm::dot(normal, towards[k]));
            most = std::max(most, sum);
        }
    return most;
}

gi::EnvironmentMap white_sky()
{
    gi::EnvironmentMap white;
    white.width = 4;
    white.height = 2;
    white.radiance.assign(8, gi::vec3{1});
    return white;
}

} // namespace

gi::EnvironmentMap studio_light()
{
    constexpr float kFloor = 0.25f, kCeiling = 0.6f, kKey = 9, kFill = 1.5f, kRim = 4;
    gi::vec3 const key = glm::normalize(gi::vec3{0.6f, 0.7f, 0.8f}),
                   fill = glm::normalize(gi::vec3{-0.9f, 0.2f, 0.5f}),
                   rim = glm::normalize(gi::vec3{-0.4f, 0.5f, -0.9f});
    gi::EnvironmentMap map;
    map.width = 128;
    map.height = 64;
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            gi::vec3 const d = direction_of((x + 0.5) / map.width, (y + 0.5) / map.height);
            map.radiance.emplace_back(glm::mix(kFloor, kCeiling, glm::smoothstep(-0.6f, 0.8f, d.y)) +
                                      kKey * within(d, key, 28) + kFill * within(d, fill, 35) +
                                      kRim * within(d, rim, 18));
        }
    float const scale = 1 / most_reflected(map);
    for (gi::vec3& radiance : map.radiance) radiance *= scale;
    return map;
}

std::string add_light(gi::Scene& scene, std::string_view choice)
{
    LightKind const own = scene.environment ? LightKind::lights : light_of(scene);
    if (choice == "none" || own == LightKind::lights || (choice == "white" && own == LightKind::glows)) return {};
    if (choice == "white") {
        scene.environment = white_sky();
        return "the scene has no light: lit by a white sky of radiance 1";
    }
    std::string const why = own == LightKind::none
                                ? "the scene has no light"
                                : "what glows in the scene, by textures of at most radiance 1, is "
                                  "not taken for its light";
    bool const unlit = is_unlit(scene);
    scene.environment = unlit ? white_sky() : studio_light();
    if (scene.background.kind == gi::BackgroundKind::map) scene.background = {gi::BackgroundKind::color, kBehind};
    if (unlit)
        return why +
               ", and all its materials are unlit: lit by a white sky of radiance 1, in which they show their "
               "base colours, before a grey background";
    return why + ": lit by studio lamps before a grey background (--light none leaves it dark)";
}

} // namespace viewer
