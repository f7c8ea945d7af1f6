#pragma once
// What a picture's pixels see first, and how those points ask along an axis: for benches of visibility.

#include "gi/core/rng.h"
#include "gi/hit_buffers/query.h"
#include "gi/render/exact_visibility.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>
#include <vector>

namespace gi {

struct SeenPoint {
    vec3 position, normal; ///< normal: unit length, on the side that is seen
    std::uint32_t triangle;
};

/// In the order of the pixels, without those that see nothing.
inline std::vector<SeenPoint> first_surfaces(World const& world, ExactVisibility const& exact,
                                             Camera const& camera, int width, int height)
{
    CameraRays const through = camera_rays(camera, width, height, world.origin);
    std::vector<RayQuery> rays;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) rays.push_back({through.through({float(x) + 0.5f, float(y) + 0.5f})});
    std::vector<Hit> hits(rays.size());
    exact.nearest(rays, hits);
    std::vector<SeenPoint> points;
    for (std::size_t k = 0; k < hits.size(); ++k) {
        if (hits[k].triangle == kNoTriangle) continue;
        Surface const& s = world.surfaces[hits[k].triangle];
        vec3 n = glm::normalize(glm::cross(s.edge1, s.edge2));
        if (glm::dot(n, rays[k].ray.direction) > 0) n = -n;
        points.push_back(
            {s.corner + hits[k].barycentric.x * s.edge1 + hits[k].barycentric.y * s.edge2, n, hits[k].triangle});
    }
    return points;
}

/// Axes on half a sphere: a lattice (Keinert et al. 2015), turned.
inline std::vector<vec3> half_sphere_axes(int n)
{
    std::vector<vec3> all;
    Frame const frame = Frame::about(glm::normalize(vec3{0.31f, 0.87f, 0.38f}));
    for (int k = 0; k < n; ++k) {
        float const z = (float(k) + 0.5f) / float(n), r = std::sqrt(1 - z * z),
                    phi = 2 * kPi * std::fmod(float(k) * 0.618034f, 1.0f) + 0.7f;
        all.push_back(frame.to_world({r * std::cos(phi), r * std::sin(phi), z}));
    }
    return all;
}

/// A ray from the point along the axis, to the side that is seen.
inline RayQuery ray_along(World const& world, SeenPoint const& p, vec3 axis, float reach = RayQuery::kFar)
{
    return {.ray = {p.position + world.surfaces[p.triangle].clearance * p.normal,
                    glm::dot(p.normal, axis) > 0 ? axis : -axis},
            .reach = reach};
}

/// The same as a look-up.
inline WalkOrigin walk_along(World const& world, SeenPoint const& p, vec3 axis)
{
    Surface const& s = world.surfaces[p.triangle];
    float const cosine = glm::dot(p.normal, axis);
    return {p.position, p.triangle, glm::dot(glm::cross(s.edge1, s.edge2), axis) > 0, cosine > 0,
            std::sqrt(std::max(0.0f, 1 - cosine * cosine)) / std::max(std::abs(cosine), 1e-4f)};
}

/// Adds rays along a point's own directions, of cosine-weighted density.
/// @param p  the point's number
inline void add_own_rays(World const& world, SeenPoint const& at, std::size_t p, int directions,
                         std::uint32_t seed, float reach, std::vector<RayQuery>& rays)
{
    Frame const frame = Frame::about(at.normal);
    Pcg32 rng(p, seed);
    vec2 const shift = rng.uniform2();
    vec3 const from = at.position + world.surfaces[at.triangle].clearance * at.normal;
    for (int k = 0; k < directions; ++k) { // a rank-1 lattice, shifted at random
        vec2 const u{std::fmod((float(k) + 0.5f) / float(directions) + shift.x, 1.0f),
                     std::fmod(float(k) * 0.618034f + shift.y, 1.0f)};
        rays.push_back({.ray = {from, frame.to_world(square_to_cosine_hemisphere(u))}, .reach = reach});
    }
}

/// The share that each point sees along axes on half a sphere, of which one more is free or not.
inline void add_axis(float& share, SeenPoint const& p, vec3 axis, int axes, bool free)
{
    if (free) share += 2 * std::abs(glm::dot(p.normal, axis)) / float(axes);
}

/// The visible share of every kJudgedEvery-th point, along 2,048 directions of its own.
inline constexpr std::size_t kJudgedEvery = 61;
inline std::vector<float> true_shares(World const& world, ExactVisibility const& exact,
                                      std::vector<SeenPoint> const& points, float reach)
{
    constexpr int kDirections = 2048;
    std::vector<float> truth((points.size() + kJudgedEvery - 1) / kJudgedEvery);
    tbb::parallel_for(std::size_t(0), truth.size(), [&](std::size_t k) {
        std::vector<RayQuery> rays;
        add_own_rays(world, points[k * kJudgedEvery], k * kJudgedEvery, kDirections, 7, reach, rays);
        std::vector<std::uint8_t> blocked(rays.size());
        exact.occluded(rays, blocked);
        truth[k] = float(std::ranges::count(blocked, 0)) / kDirections;
    });
    return truth;
}

inline double rms_error(std::vector<float> const& share, std::vector<float> const& truth)
{
    double sum = 0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
        double const off = double(share[k * kJudgedEvery]) - double(truth[k]);
        sum += off * off;
    }
    return std::sqrt(sum / double(truth.size()));
}

/// Shares points between threads: work(first, end).
template <class Work>
void each_part(std::size_t points, Work const& work)
{
    constexpr std::size_t kPart = 4096;
    tbb::parallel_for(std::size_t(0), (points + kPart - 1) / kPart,
                      [&](std::size_t k) { work(k * kPart, std::min(points, (k + 1) * kPart)); });
}

} // namespace gi
