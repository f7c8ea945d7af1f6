#include "gi/light_paths/reached_points.h"

#include "gi/core/rng.h"
#include "gi/light_paths/emission.h"
#include "gi/scene/shading/shading_point.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>

namespace gi {
namespace {

constexpr int kBounces = 6;

vec3 to_sphere(vec2 u)
{
    float const z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z));
    vec2 const turn = azimuth(u.y);
    return {r * turn.x, r * turn.y, z};
}

std::vector<Ray> from_lights(World const& world, Bounds const& focus, std::size_t n, Pcg32& rng)
{
    WorldView const w = view(world);
    std::vector<Ray> rays;
    for (std::size_t k = 0; k < n; ++k) {
        LightChoice const choice = choose_light(w, rng.uniform_double());
        vec2 const place = rng.uniform2(), direction = rng.uniform2();
        bool const through_focus = !focus.empty() && k % 2 != 0 && comes_from_afar(w, choice);
        EmittedLight light =
            emit_light(w, choice, through_focus ? focus : world.bounds, place, direction, rng.uniform());
        if (through_focus) light.ray.origin -= 2 * world.bounds.radius() * light.ray.direction;
        if (max_component(light.power) > 0) rays.push_back(light.ray);
    }
    return rays;
}

std::vector<Ray> from_cameras(World const& world, std::size_t n, Pcg32& rng)
{
    std::vector<Ray> rays;
    for (std::size_t k = 0; k < n && !world.cameras.empty(); ++k) {
        Camera const& camera = world.cameras[k % world.cameras.size()];
        rays.push_back({vec3(dvec3(camera.world_from_camera[3]) - world.origin), to_sphere(rng.uniform2())});
    }
    return rays;
}

std::vector<Ray> from_surfaces(World const& world, std::size_t n, Pcg32& rng)
{
    std::vector<double> area;
    double sum = 0;
    for (Surface const& s : world.surfaces)
        area.push_back(sum += double(glm::length(glm::cross(s.edge1, s.edge2))));
    std::vector<Ray> rays;
    for (std::size_t k = 0; k < n && !area.empty(); ++k) {
        // If all areas are 0 in floats, all triangles have equal probability.
        auto const at = std::size_t(std::ranges::upper_bound(area, rng.uniform_double() * sum) - area.begin());
        Surface const& s = world.surfaces[sum > 0 ? std::min(at, area.size() - 1) : k % area.size()];
        vec2 const w = square_to_triangle(rng.uniform2());
        vec3 const normal = shading_detail::triangle_normal(s) * (rng.uniform() < 0.5f ? -1.0f : 1.0f);
        vec3 const direction = Frame::about(normal).to_world(square_to_cosine_hemisphere(rng.uniform2()));
        vec3 const position = s.corner + w.x * s.edge1 + w.y * s.edge2;
        // A ray back onto the surface, so that its hit is computed like others.
        float const off = 16 * s.clearance;
        rays.push_back({position + off * direction, -direction});
    }
    return rays;
}

Reached walk_on(World const& world, ExactVisibility const& visibility, std::vector<Ray> rays, Pcg32& rng)
{
    WorldView const w = view(world);
    Reached reached;
    std::size_t left = 0; // index of the point that the first ray left
    for (int bounce = 0; bounce <= kBounces && !rays.empty(); ++bounce) {
        std::vector<RayQuery> queries;
        for (Ray const& r : rays) queries.push_back({.ray = r, .seed = rng.next()});
        std::vector<Hit> hits(queries.size());
        visibility.nearest(queries, hits);
        rays.clear();
        std::size_t const points = reached.points.size();
        for (std::size_t k = 0; k < hits.size(); ++k) {
            Ray const& ray = queries[k].ray;
            // The lengths of first rays from distant lights and from cameras say nothing
            // about the space between surfaces.
            if (bounce > 0) {
                float const length = hits[k].triangle != kNoTriangle ? hits[k].distance : kInf;
                reached.flights.push_back({ray.origin, ray.direction, length, reached.points[left + k].triangle});
                reached.points[left + k].free = length;
            }
            if (hits[k].triangle == kNoTriangle || bounce == kBounces) continue;
            ShadingPoint const at = shading_point(w, hits[k].triangle, hits[k].barycentric, ray.direction);
            reached.points.push_back({at.position, at.geometric_normal, at.clearance, hits[k].triangle});
            vec3 const next =
                Frame::about(at.geometric_normal).to_world(square_to_cosine_hemisphere(rng.uniform2()));
            rays.push_back({leave(at, next), next});
        }
        left = points;
    }
    return reached;
}

} // namespace

Reached reach(World const& world, ExactVisibility const& visibility, std::size_t walks, std::uint64_t seed,
              Bounds const& focus)
{
    if (world.triangles.empty()) return {};
    Pcg32 rng(seed, 5);
    std::vector<Ray> rays = from_lights(world, focus, walks, rng);
    std::vector<Ray> const more = from_cameras(world, walks, rng);
    rays.insert(rays.end(), more.begin(), more.end());
    Reached reached = walk_on(world, visibility, std::move(rays), rng);
    if (reached.points.empty()) reached = walk_on(world, visibility, from_surfaces(world, 2 * walks, rng), rng);
    return reached;
}

} // namespace gi
