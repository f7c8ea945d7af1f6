#include "viewer/engine/live/ground.h"

namespace viewer {

Ground::Ground(gi::World const& world)
{
    still_.scene = std::make_shared<gi::Scene const>(); // no textures
    still_.origin = world.origin;
    still_.positions.assign(world.positions.begin(), world.positions.begin() + world.static_vertices);
    still_.triangles.assign(world.triangles.begin(), world.triangles.begin() + world.static_triangles);
    rays_ = std::make_unique<gi::ExactVisibility>(still_, false, 0);
}

std::optional<Ground::Touch> Ground::touch(gi::dvec3 from, gi::dvec3 direction, double reach_m) const
{
    gi::RayQuery const query{{gi::vec3(from - still_.origin), gi::vec3(direction)}, float(reach_m), 0};
    gi::Hit hit;
    rays_->nearest({&query, 1}, {&hit, 1});
    if (hit.triangle == gi::kNoTriangle) return std::nullopt;
    glm::uvec3 const v = still_.triangles[hit.triangle];
    gi::dvec3 const corner(still_.positions[v.x]);
    gi::dvec3 normal = glm::normalize(
        glm::cross(gi::dvec3(still_.positions[v.y]) - corner, gi::dvec3(still_.positions[v.z]) - corner));
    if (glm::dot(normal, direction) > 0) normal = -normal;
    return Touch{double(hit.distance), normal};
}

} // namespace viewer
