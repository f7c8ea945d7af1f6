#pragma once
// Imperfect shadow maps (Ritschel et al. 2008): for every virtual light, the distances of the surrounding
// surfaces, from a small set of points, with holes filled by pull-push.
//
// A map is size x size texels over the hemisphere about the light's normal, by the octahedral map of a hemisphere
// (Cigolle et al. 2014; Ritschel et al. use paraboloids, which leave the square's corners unused): u = (px + py,
// px - py) with p = (x, y) / (|x| + |y| + z). Row-major. A texel holds the *octahedral distance* |x| + |y| + z of
// the surface at its centre, m, kInf if unknown: with d = (px, py, 1 - |px| - |py|) of the centre, it is the t
// for which t d lies on the surface, so that intersecting planes needs no square root.
//
// A point is drawn as a disk in its surface (so the distance at a texel's centre is that of the surface, not of
// the point), over at most 5 x 5 texels. Holes between disks are filled from coarser levels: a texel of the next
// level is the mean of those of its four texels that are about as near as the nearest of them.

#include "gi/light_paths/light_paths.h"
#include "gi/methods/vpl/settings.h"
#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

#include <algorithm>
#include <span>
#include <vector>

namespace gi {

/// Surfaces as points (Ritschel et al. 2008, sec. 3.1): each point represents the same area, as a disk in its surface.
struct PointCloud {
    /// A power of two. Any 2^k points that start at a multiple of 2^k are evenly
    /// distributed over the area (Sobol).
    static constexpr std::uint32_t kCount = std::uint32_t(kMostPoints);

    std::vector<vec3> position; ///< kCount points, or none without surfaces
    std::vector<vec3> normal;   ///< unit, counter-clockwise side; 0 = the point is cut out by alpha
    double area_m2 = 0;         ///< of all surfaces
    /// Radius of the disks of n points, m: together they have twice the area of all surfaces, and cover six
    /// sevenths of it, as they overlap.
    float disk_radius(std::uint32_t n) const { return float(std::sqrt(2 * area_m2 / (glm::pi<double>() * n))); }
};

PointCloud make_point_cloud(World const& world, std::uint64_t seed);

/// Texels of a map.
struct HemisphereGrid {
    std::uint32_t size; ///< texels per side, a power of two

    static float octahedral_distance(vec3 v) { return std::abs(v.x) + std::abs(v.y) + v.z; }
    /// In [0, size]^2. @param v local, z >= 0, not 0
    vec2 square_from(vec3 v) const
    {
        float const scale = 1 / octahedral_distance(v);
        vec2 const p{v.x * scale, v.y * scale};
        return 0.5f * float(size) * vec2{1 + p.x + p.y, 1 + p.x - p.y};
    }
    int coordinate(float u) const { return std::clamp(int(u), 0, int(size) - 1); }
    /// Local direction through the centre of texel (x, y), with octahedral distance 1.
    vec3 direction(int x, int y) const
    {
        float const step = 1 / float(size), u = float(2 * x + 1) * step - 1, v = float(2 * y + 1) * step - 1;
        float const px = 0.5f * (u + v), py = 0.5f * (u - v);
        return {px, py, 1 - std::abs(px) - std::abs(py)};
    }
};

struct PointSubset {
    std::uint32_t first = 0, count = 0; ///< consecutive points of the cloud, wrapping around
};

/// @param map  grid.size squared  @param scratch  reusable buffer
void draw_imperfect_map(PointCloud const& cloud, PointSubset subset, LightVertex const& light, HemisphereGrid grid,
                        std::span<float> map, std::vector<float>& scratch);

/// A virtual light with its map.
struct MappedLight {
    vec3 position;
    Frame frame; ///< about its normal
    float const* map;
};

/// True if a surface receives light. @param normal  unit  @param slack  m; tolerated distance behind the stored
/// surface, in addition to the width of a texel at that distance
inline bool is_lit(MappedLight const& light, HemisphereGrid grid, vec3 position, vec3 normal, float slack)
{
    vec3 at = light.frame.to_local(position - light.position);
    at.z = std::max(at.z, 0.0f); // rounding
    vec2 const u = grid.square_from(at);
    int const x = grid.coordinate(u.x), y = grid.coordinate(u.y);
    // Distance of the receiver's plane at the texel's centre, limited to near the receiver.
    float const own = HemisphereGrid::octahedral_distance(at);
    float const plane =
        glm::dot(normal, position - light.position) / glm::dot(normal, light.frame.to_world(grid.direction(x, y)));
    float const distance = plane > 0 && plane < 2 * own ? plane : own;
    float const there = light.map[y * int(grid.size) + x];
    return distance <= there + there * (2 / float(grid.size)) + slack;
}

} // namespace gi
