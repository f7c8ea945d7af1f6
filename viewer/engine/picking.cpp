#include "viewer/engine/picking.h"

#include <algorithm>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace viewer {
namespace {

using gi::vec3;

struct Nearest {
    float distance = gi::kInf;
    std::uint32_t triangle = 0;
};

/// Moeller and Trumbore 1997.
float distance_to(gi::Ray const& ray, gi::Surface const& s)
{
    vec3 const p = glm::cross(ray.direction, s.edge2);
    float const det = glm::dot(s.edge1, p);
    if (det == 0) return gi::kInf;
    vec3 const from = ray.origin - s.corner, q = glm::cross(from, s.edge1);
    float const u = glm::dot(from, p) / det, v = glm::dot(ray.direction, q) / det, t = glm::dot(s.edge2, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : gi::kInf;
}

Nearest nearest(gi::World const& world, gi::Ray const& ray)
{
    using Range = tbb::blocked_range<std::size_t>;
    return tbb::parallel_reduce(
        Range(0, world.surfaces.size(), 4096), Nearest{},
        [&](Range const& range, Nearest best) {
            for (std::size_t t = range.begin(); t < range.end(); ++t)
                if (float const d = distance_to(ray, world.surfaces[t]); d < best.distance)
                    best = {d, std::uint32_t(t)};
            return best;
        },
        [](Nearest a, Nearest b) { return b.distance < a.distance ? b : a; });
}

} // namespace

std::optional<Picked> pick(gi::World const& world, gi::Camera const& camera, double aspect, glm::dvec2 at)
{
    constexpr int kSide = 4096; // any value works: the position in the picture is continuous
    int const width = std::max(1, int(std::lround(kSide * aspect)));
    gi::Ray const ray = gi::camera_rays(camera, width, kSide, world.origin)
                            .through(gi::vec2(float(at.x * width), float(at.y * kSide)));
    Nearest const found = nearest(world, ray);
    if (!(found.distance < gi::kInf)) return std::nullopt;
    auto const next = std::upper_bound(world.placed.begin(), world.placed.end(), found.triangle,
                                       [](std::uint32_t t, auto const& p) { return t < p.first_triangle; });
    return Picked{found.triangle, std::prev(next)->node, world.surfaces[found.triangle].material,
                  double(found.distance), world.origin + gi::dvec3(ray.origin + found.distance * ray.direction)};
}

double free_way_m(gi::World const& world, gi::dvec3 from, gi::dvec3 direction, double most_m)
{
    gi::Ray const ray{vec3(from - world.origin), vec3(direction)};
    return std::min(most_m, double(nearest(world, ray).distance));
}

} // namespace viewer
