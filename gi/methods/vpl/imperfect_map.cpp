#include "gi/methods/vpl/imperfect_map.h"

#include "gi/core/rqmc.h"
#include "gi/scene/shading/shading_point.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Sine of the elevation below which points are omitted, as they belong to the light's own surface.
constexpr float kHorizon = 0.01f;
/// A disk covers at most (2 * kReach + 1)^2 texels.
constexpr int kReach = 2;
/// Largest ratio of distances that are averaged to fill a hole.
constexpr float kAlike = 1.1f;

/// A point of the cloud as seen from a light: a disk.
struct Disk {
    vec3 centre, normal; ///< local
    float radius;
};

/// Texels of a row that are tested together.
constexpr int kLanes = 8;
static_assert(kLanes >= 2 * kReach + 2);

/// @param map  with room for kLanes more values
void draw(Disk const& disk, HemisphereGrid grid, float* map)
{
    vec3 const at = disk.centre;
    float const squared = glm::dot(at, at);
    if (!(at.z > 0) || !(square(at.z) > square(kHorizon) * squared)) return;
    float const own = HemisphereGrid::octahedral_distance(at), offset = glm::dot(disk.normal, at);
    vec2 const centre = grid.square_from(at);
    auto const n = int(grid.size);
    // An angle of 1 rad is about half the square wide, in texels.
    float const wide = std::min(0.5f * float(n) * disk.radius / std::sqrt(squared), float(kReach) + 0.5f);
    int const left = grid.coordinate(centre.x - wide), right = grid.coordinate(centre.x + wide);
    int const top = grid.coordinate(centre.y - wide), bottom = grid.coordinate(centre.y + wide);
    float const radius_squared = square(disk.radius);
    for (int y = top; y <= bottom; ++y) {
        float* const row = map + y * n + left;
        for (int k = 0; k < kLanes; ++k) { // without branches, so that it vectorises
            vec3 const d = grid.direction(left + k, y);
            float const t = offset / glm::dot(disk.normal, d);
            vec3 const beside = t * d - at;
            bool const covers = (left + k <= right) & (glm::dot(beside, beside) <= radius_squared);
            row[k] = std::min(row[k], covers ? t : kInf);
        }
    }
    // Even a tiny disk covers the texel of its centre.
    int const x = grid.coordinate(centre.x), y = grid.coordinate(centre.y);
    float const t = offset / glm::dot(disk.normal, grid.direction(x, y));
    map[y * n + x] = std::min(map[y * n + x], t > 0.5f * own && t < 2 * own ? t : own);
}

/// Levels needed until every texel has a point, if the points were evenly distributed.
int levels_for(std::uint32_t size, std::uint32_t points)
{
    double const texels_each = double(size) * size / std::max(1u, points);
    int const wanted = int(std::ceil(0.5 * std::log2(std::max(1.0, 4 * texels_each))));
    return std::min(wanted, int(std::log2(double(size))) - 1);
}

void pull(float const* fine, std::uint32_t fine_size, float* coarse)
{
    std::uint32_t const n = fine_size / 2;
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            float const* const corner = fine + 2 * y * fine_size + 2 * x;
            float const four[4] = {corner[0], corner[1], corner[fine_size], corner[fine_size + 1]};
            float const nearest = std::min(std::min(four[0], four[1]), std::min(four[2], four[3]));
            float farthest = nearest;
            for (float const v : four) farthest = v <= kAlike * nearest ? std::max(farthest, v) : farthest;
            coarse[y * n + x] = farthest;
        }
}

void push(float const* coarse, std::uint32_t fine_size, float* fine)
{
    std::uint32_t const n = fine_size / 2;
    for (std::uint32_t y = 0; y < fine_size; ++y)
        for (std::uint32_t x = 0; x < fine_size; ++x) {
            float& v = fine[y * fine_size + x];
            float const filled = coarse[y / 2 * n + x / 2];
            v = v < kInf ? v : filled;
        }
}

/// @param map  followed by room for all coarser levels
void fill_holes(float* map, std::uint32_t size, int levels)
{
    float* level[16] = {map};
    float* next = map + std::size_t(size) * size;
    for (int k = 1; k <= levels; ++k) {
        std::uint32_t const finer = size >> (k - 1);
        level[k] = next;
        next += std::size_t(finer / 2) * (finer / 2);
        pull(level[k - 1], finer, level[k]);
    }
    for (int k = levels; k >= 1; --k) push(level[k], size >> (k - 1), level[k - 1]);
}

} // namespace

PointCloud make_point_cloud(World const& world, std::uint64_t seed)
{
    PointCloud cloud;
    std::vector<double> area_up_to;
    area_up_to.reserve(world.surfaces.size());
    for (Surface const& s : world.surfaces) {
        double const area = 0.5 * double(glm::length(glm::cross(s.edge1, s.edge2)));
        cloud.area_m2 += std::isfinite(area) ? area : 0;
        area_up_to.push_back(cloud.area_m2);
    }
    if (!(cloud.area_m2 > 0)) return cloud;
    cloud.position.resize(PointCloud::kCount);
    cloud.normal.resize(PointCloud::kCount);
    WorldView const w = view(world);
    auto const stream = std::uint32_t(mix_bits(seed ^ 0x9012));
    tbb::parallel_for(0u, PointCloud::kCount, [&](std::uint32_t i) {
        vec4 const u = RqmcStream(stream, i).sample_together(0);
        double const wanted = double(u.x) * cloud.area_m2;
        auto const at = std::upper_bound(area_up_to.begin(), area_up_to.end(), wanted) - area_up_to.begin();
        auto const triangle = std::uint32_t(std::min<std::ptrdiff_t>(at, std::ptrdiff_t(area_up_to.size()) - 1));
        vec2 const weights = square_to_triangle({u.y, u.z});
        Surface const& s = world.surfaces[triangle];
        cloud.position[i] = s.corner + weights.x * s.edge1 + weights.y * s.edge2;
        bool const there = u.w < coverage(w, triangle, weights);
        cloud.normal[i] = there ? shading_detail::triangle_normal(s) : vec3{0};
    });
    return cloud;
}

void draw_imperfect_map(PointCloud const& cloud, PointSubset subset, LightVertex const& light, HemisphereGrid grid,
                        std::span<float> map, std::vector<float>& scratch)
{
    scratch.resize(map.size() + map.size() / 3 + kLanes); // 1 + 1/4 + 1/16 + ...
    std::fill(scratch.begin(), scratch.end(), kInf);
    Frame const frame = Frame::about(light.normal);
    float const radius = cloud.disk_radius(subset.count);
    for (std::uint32_t k = 0; k < subset.count && !cloud.position.empty(); ++k) {
        std::uint32_t const i = (subset.first + k) % PointCloud::kCount;
        if (cloud.normal[i] == vec3{0}) continue;
        draw({frame.to_local(cloud.position[i] - light.position), frame.to_local(cloud.normal[i]), radius}, grid,
             scratch.data());
    }
    fill_holes(scratch.data(), grid.size, levels_for(grid.size, subset.count));
    std::copy_n(scratch.begin(), map.size(), map.begin());
}

} // namespace gi
