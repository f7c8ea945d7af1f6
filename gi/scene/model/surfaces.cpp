#include "gi/scene/shading/shading_point.h"
#include "gi/scene/shading/world_tables.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Relative clearance: rounding errors of the vertices and of interpolation scale with the coordinates.
constexpr float kClearance = 2e-6f;

Surface surface_of(World const& world, std::size_t triangle)
{
    Surface s;
    s.vertex = world.triangles[triangle];
    s.corner = world.positions[s.vertex.x];
    s.edge1 = world.positions[s.vertex.y] - s.corner;
    s.edge2 = world.positions[s.vertex.z] - s.corner;
    vec3 const area = glm::cross(s.edge1, s.edge2);
    float const squared = glm::dot(area, area);
    s.normal_scale = squared > 1e-30f && squared < 1e30f ? 1 / std::sqrt(squared) : 0;
    s.clearance = 0;
    for (int k = 0; k < 3; ++k)
        s.clearance = std::max(s.clearance, kClearance * max_component(glm::abs(world.positions[s.vertex[k]])));
    s.material = world.triangle_material[triangle];
    s.flags = 0;
    Material const& m = world.materials[s.material];
    if (has_textures(m) || !world.colors.empty()) s.flags |= Surface::kVaries;
    if (emits(m)) s.flags |= Surface::kEmits;
    if (m.double_sided) s.flags |= Surface::kDoubleSided;
    if (m.alpha_mode == AlphaMode::blend) s.flags |= Surface::kBlended;
    if (world.normals.empty()) return s;
    constexpr float kFlat = 1e-4f; // rad; exceeds the angle error of a small box in float coordinates
    vec3 const n = shading_detail::triangle_normal(s);
    for (int k = 0; k < 3; ++k) {
        vec3 const given = world.normals[s.vertex[k]];
        float const length = glm::length(given);
        if (length > 0 && glm::length(glm::cross(n, given)) > kFlat * length) s.flags |= Surface::kSmooth;
    }
    return s;
}

} // namespace

void build_bsdfs(World& world)
{
    world.bsdfs.clear();
    for (Material const& m : world.materials) world.bsdfs.push_back(make_bsdf(m));
}

void update_surfaces(World& world, std::size_t first, std::size_t end)
{
    tbb::parallel_for(first, end, [&](std::size_t t) { world.surfaces[t] = surface_of(world, t); });
}

void update_surfaces_of(World& world, std::uint32_t material)
{
    tbb::parallel_for(std::size_t(0), world.triangles.size(), [&](std::size_t t) {
        if (world.triangle_material[t] == material) world.surfaces[t] = surface_of(world, t);
    });
}

} // namespace gi
