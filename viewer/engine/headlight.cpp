#include "viewer/engine/headlight.h"

#include <algorithm>
#include <numbers>

namespace viewer {

Headlight headlight_of(gi::World const& world)
{
    if (world.bounds.empty()) return {};
    return {world.origin + gi::dvec3(world.bounds.center()), std::max(1e-6, double(world.bounds.radius()))};
}

gi::dvec3 eye_of(std::span<ViewCommand const> views)
{
    auto const at = [](ViewCommand const& v) { return gi::dvec3(v.camera.world_from_camera[3]); };
    auto const other = std::ranges::find(views.subspan(1), 0, &ViewCommand::partner);
    return other == views.end() ? at(views[0]) : 0.5 * (at(views[0]) + at(*other));
}

gi::Light light_at(Headlight const& h, gi::dvec3 eye, gi::dvec3 origin)
{
    double const distance = std::max(h.radius_m, glm::length(eye - h.center));
    gi::Light light;
    light.position = gi::vec3(eye - origin);
    light.intensity = gi::vec3(float(std::numbers::pi * distance * distance));
    return light;
}

std::shared_ptr<gi::Scene const> with_headlight(gi::Scene const& scene)
{
    auto lit = std::make_shared<gi::Scene>(scene);
    gi::Node& node = lit->nodes.emplace_back();
    node.name = "headlight";
    node.light = std::int32_t(lit->lights.size());
    node.driven = true;
    lit->lights.emplace_back();
    return lit;
}

std::shared_ptr<gi::Scene const> without_headlight(gi::Scene const& scene)
{
    auto unlit = std::make_shared<gi::Scene>(scene);
    unlit->nodes.pop_back();
    unlit->lights.pop_back();
    return unlit;
}

} // namespace viewer
