#pragma once
// Where the rays and look-ups of the bench start.

#include "gi/core/rng.h"
#include "gi/render/exact_visibility.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <vector>

namespace gi::bench {

/// Where rays start: a point on a triangle, and the side of it that they leave.
struct Start {
    std::uint32_t triangle;
    vec3 position, normal;
};

inline vec3 normal_of(Surface const& s) { return glm::normalize(glm::cross(s.edge1, s.edge2)); }

inline std::vector<Start> anywhere(World const& world, std::size_t n)
{
    std::vector<double> area;
    double sum = 0;
    for (Surface const& s : world.surfaces)
        area.push_back(sum += double(glm::length(glm::cross(s.edge1, s.edge2))));
    Pcg32 rng(1, 2);
    std::vector<Start> starts;
    for (std::size_t i = 0; i < n; ++i) {
        auto const at = std::ranges::upper_bound(area, rng.uniform_double() * sum);
        auto const t = std::uint32_t(std::min(std::size_t(at - area.begin()), area.size() - 1));
        Surface const& s = world.surfaces[t];
        vec2 const w = square_to_triangle(rng.uniform2());
        starts.push_back(
            {t, s.corner + w.x * s.edge1 + w.y * s.edge2, rng.uniform() < 0.5f ? -normal_of(s) : normal_of(s)});
    }
    return starts;
}

/// First surfaces of a square picture of n pixels, in rows.
inline std::vector<Start> first_surfaces(World const& world, ExactVisibility const& exact, std::size_t n)
{
    auto const side = int(std::sqrt(double(n)));
    CameraRays const camera = camera_rays(world.cameras.at(0), side, side, world.origin);
    std::vector<RayQuery> rays;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            rays.push_back({.ray = camera.through({float(x) + 0.5f, float(y) + 0.5f}), .seed = 0});
    std::vector<Hit> hits(rays.size());
    exact.nearest(rays, hits);
    std::vector<Start> starts;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].triangle == kNoTriangle) continue;
        Surface const& s = world.surfaces[hits[i].triangle];
        vec3 const normal = normal_of(s);
        starts.push_back({hits[i].triangle,
                          s.corner + hits[i].barycentric.x * s.edge1 + hits[i].barycentric.y * s.edge2,
                          glm::dot(normal, rays[i].ray.direction) < 0 ? normal : -normal});
    }
    return starts;
}

} // namespace gi::bench
