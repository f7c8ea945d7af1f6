#include "gi/methods/paths/motion.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Weights of corners 1 and 2 where a pixel's ray hits the triangle's plane; not clamped to the triangle.
vec2 weights_at(Ray const& ray, vec3 corner, vec3 edge1, vec3 edge2)
{
    vec3 const normal = glm::cross(edge1, edge2);
    float const squared = glm::dot(normal, normal), facing = glm::dot(normal, ray.direction);
    vec3 const from = ray.origin - corner;
    if (squared == 0 || facing == 0) return vec2{1.0f / 3};
    vec3 const p = from - glm::dot(normal, from) / facing * ray.direction;
    return vec2{glm::dot(glm::cross(p, edge2), normal), glm::dot(glm::cross(edge1, p), normal)} / squared;
}

Corners corners_at(TriangleSoup const& soup, std::size_t triangle)
{
    return {soup.vertex(triangle, 0), soup.vertex(triangle, 1), soup.vertex(triangle, 2)};
}

} // namespace

std::vector<Corners> corners_of(TriangleSoup const& soup, std::size_t first)
{
    std::vector<Corners> corners(first < soup.count ? soup.count - first : 0);
    tbb::parallel_for(std::size_t(0), corners.size(),
                      [&](std::size_t k) { corners[k] = corners_at(soup, first + k); });
    return corners;
}

void add_motion(PrimaryMap const& primary, TriangleSoup const& soup, CameraRays const& now,
                CameraRays const& camera_before, EarlierCorners const& before, Picture& picture)
{
    std::size_t const width = std::size_t(picture.width);
    auto const seen = [&](std::size_t y, std::span<SeenPoint> row) {
        thread_local std::vector<PathStart> starts;
        primary.hits(y * width, (y + 1) * width, starts);
        for (std::size_t x = 0; x < width; ++x) {
            PathStart const& start = starts[x];
            if (start.triangle == kNoPrimitive) continue;
            Corners const c = corners_at(soup, start.triangle);
            vec2 const w = weights_at(start.ray, c[0], c[1] - c[0], c[2] - c[0]);
            row[x] = {start.triangle, w, point_on(c, w)};
        }
    };
    add_motion(seen, now, camera_before, before, picture);
}

} // namespace gi
