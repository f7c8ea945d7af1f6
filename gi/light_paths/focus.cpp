#include "gi/light_paths/focus.h"

#include "gi/core/rng.h"
#include "gi/render/sampling.h"
#include "gi/scene/shading/shading_point.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>

namespace gi {

std::vector<ShownPoint> shown_surfaces(World const& world, ExactVisibility const& visibility,
                                       std::span<FrameView const> views, int side, int surfaces)
{
    WorldView const w = view(world);
    std::vector<ShownPoint> points;
    std::vector<RayQuery> queries;
    for (FrameView const& v : views) {
        CameraRays const camera = camera_rays(v.camera, v.width, v.height, world.origin);
        for (int k = 0; k < side * side; ++k) {
            vec2 const at = (vec2{float(k % side), float(k / side)} + 0.5f) / float(side);
            Ray const ray = camera.through(at * vec2{float(v.width), float(v.height)});
            queries.push_back({.ray = ray, .seed = std::uint32_t(k), .start = camera_clearance(ray.origin)});
        }
    }
    Pcg32 rng(7, 7);
    for (int surface = 0; surface < surfaces; ++surface) {
        std::vector<Hit> hits(queries.size());
        visibility.nearest(queries, hits);
        std::vector<RayQuery> next;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            if (hits[k].triangle == kNoTriangle) continue;
            ShadingPoint const at =
                shading_point(w, hits[k].triangle, hits[k].barycentric, queries[k].ray.direction);
            points.push_back({at.position, hits[k].triangle, at.front});
            vec3 const direction =
                Frame::about(at.geometric_normal).to_world(square_to_cosine_hemisphere(rng.uniform2()));
            next.push_back({.ray = {leave(at, direction), direction}, .seed = rng.next()});
        }
        queries = std::move(next);
    }
    return points;
}

std::vector<vec3> shown_points(World const& world, ExactVisibility const& visibility,
                               std::span<FrameView const> views)
{
    std::vector<vec3> points;
    for (ShownPoint const& p : shown_surfaces(world, visibility, views, 32, 2)) points.push_back(p.position);
    return points;
}

Bounds focus_of(std::span<vec3 const> points, int voxels)
{
    if (points.empty()) return {};
    Bounds box;
    std::vector<float> along(points.size());
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < points.size(); ++k) along[k] = points[k][axis];
        std::ranges::sort(along);
        std::size_t const cut = points.size() / 100;
        box.low[axis] = along[cut];
        box.high[axis] = along[points.size() - 1 - cut];
    }
    float const cell = 4 / float(std::max(voxels, 16)), around = std::max(0.05f, 1.5f * cell / (1 - 3 * cell));
    float const margin = around * max_component(box.high - box.low);
    return {box.low - margin, box.high + margin};
}

float longest_side(Bounds const& b) { return b.empty() ? 0 : max_component(b.high - b.low); }

bool needs_fine_grid(Bounds const& focus, Bounds const& world)
{
    return longest_side(focus) > 0 && longest_side(focus) < 0.5f * longest_side(world);
}

Bounds focus_in(Bounds const& world, std::span<vec3 const> points, int voxels)
{
    Bounds const shown = focus_of(points, voxels);
    if (!needs_fine_grid(shown, world)) return {};
    return {glm::max(shown.low, world.low), glm::min(shown.high, world.high)};
}

bool holds(Bounds const& box, Bounds const& inner)
{
    return glm::all(glm::lessThanEqual(box.low, inner.low)) && glm::all(glm::lessThanEqual(inner.high, box.high));
}

double share_in(Bounds const& box, std::span<vec3 const> points)
{
    auto const inside = std::ranges::count_if(points, [&](vec3 p) { return holds(box, {p, p}); });
    return points.empty() ? 1 : double(inside) / double(points.size());
}

} // namespace gi
