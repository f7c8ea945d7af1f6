#include "gi/slhb/motion.h"

#include "gi/scene/projection.h"

#include <limits>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Where rays through pixels meet a triangle, in weights of its corners 1 and 2; not held to its inside.
vec2 weights_at(Ray const& ray, vec3 corner, vec3 edge1, vec3 edge2)
{
    vec3 const normal = glm::cross(edge1, edge2);
    float const squared = glm::dot(normal, normal), facing = glm::dot(normal, ray.direction);
    vec3 const from = ray.origin - corner;
    if (squared == 0 || facing == 0) return vec2{1.0f / 3};
    vec3 const p = from - glm::dot(normal, from) / facing * ray.direction;
    return vec2{glm::dot(glm::cross(p, edge2), normal), glm::dot(glm::cross(edge1, p), normal)} / squared;
}

} // namespace

std::vector<std::array<vec3, 3>> corners_of(TriangleSoup const& soup, std::size_t first)
{
    std::vector<std::array<vec3, 3>> corners(first < soup.count ? soup.count - first : 0);
    tbb::parallel_for(std::size_t(0), corners.size(), [&](std::size_t k) {
        for (std::size_t c = 0; c < 3; ++c) corners[k][c] = soup.vertex(first + k, c);
    });
    return corners;
}

void add_motion(PrimaryMap const& primary, TriangleSoup const& soup, CameraRays const& now,
                CameraRays const& camera_before, EarlierCorners const& before, Picture& picture)
{
    std::vector<float>& out = picture.add("motion", 3).data;
    std::size_t const width = std::size_t(picture.width), height = std::size_t(picture.height);
    Projection const project_now(now), project_before(camera_before);
    tbb::parallel_for(std::size_t(0), height, [&](std::size_t y) {
        thread_local std::vector<PathStart> starts;
        primary.hits(y * width, (y + 1) * width, starts);
        for (PathStart const& start : starts) {
            float* const to = &out[3 * std::size_t(start.stream)];
            std::fill_n(to, 3, std::numeric_limits<float>::quiet_NaN());
            if (start.triangle == kNoPrimitive) continue;
            std::size_t const t = start.triangle;
            vec3 const corner = soup.vertex(t, 0), edge1 = soup.vertex(t, 1) - corner,
                       edge2 = soup.vertex(t, 2) - corner;
            vec2 const w = weights_at(start.ray, corner, edge1, edge2);
            vec3 const here = corner + w.x * edge1 + w.y * edge2;
            vec3 there = here;
            if (t >= before.first_moving && !before.corners.empty()) {
                auto const& c = before.corners[t - before.first_moving];
                there = c[0] + w.x * (c[1] - c[0]) + w.y * (c[2] - c[0]);
            }
            vec3 const from = project_now(here), at = project_before(there);
            if (!(at.z > 0)) continue;
            to[0] = at.x - from.x;
            to[1] = at.y - from.y;
            to[2] = at.z;
        }
    });
}

} // namespace gi
