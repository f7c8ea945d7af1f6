#pragma once
// Imperfect shadow maps (Ritschel et al. 2008): for every virtual light the distance of the surfaces around it,
// from a small set of points, with holes filled by pull-push.
//
// A map is size x size texels over the hemisphere about the light's normal, by the octahedral map of a hemisphere
// (Cigolle et al. 2014; the paper has paraboloids, which leave corners of the square unused): u = (px + py, px -
// py) with p = (x, y) / (|x| + |y| + z). Row-major. A texel holds the *octahedral distance* |x| + |y| + z of the
// surface at its centre, m, kInf where nothing is known: with d = (px, py, 1 - |px| - |py|) of the centre that is
// the t of t d on the surface, so that planes meet it without a square root.
//
// A point is drawn as a disk in its surface (so the distance at a texel's centre is that of the surface, not of
// the point), over at most 5 x 5 texels. Where disks do not reach, coarser levels fill the hole: a texel of the
// next level is the mean of those of its four that are about as near as the nearest of them.

#include "gi/methods/vpl/point_cloud.h"
#include "gi/methods/vpl/virtual_lights.h"

#include <algorithm>
#include <span>

namespace gi {

/// Texels of a map.
struct HemisphereGrid {
    std::uint32_t size; ///< on a side, a power of two

    static float octahedral_distance(vec3 v) { return std::abs(v.x) + std::abs(v.y) + v.z; }
    /// In [0, size]^2. @param v local, z >= 0, not 0
    vec2 square_from(vec3 v) const
    {
        float const scale = 1 / octahedral_distance(v);
        vec2 const p{v.x * scale, v.y * scale};
        return 0.5f * float(size) * vec2{1 + p.x + p.y, 1 + p.x - p.y};
    }
    int coordinate(float u) const { return std::clamp(int(u), 0, int(size) - 1); }
    /// Of octahedral distance 1, local: through the centre of texel (x, y).
    vec3 direction(int x, int y) const
    {
        float const step = 1 / float(size), u = float(2 * x + 1) * step - 1, v = float(2 * y + 1) * step - 1;
        float const px = 0.5f * (u + v), py = 0.5f * (u - v);
        return {px, py, 1 - std::abs(px) - std::abs(py)};
    }
};

struct PointSubset {
    std::uint32_t first = 0, count = 0; ///< of the cloud, round about
};

/// @param map  grid.size squared  @param scratch  memory that is used again
void draw_imperfect_map(PointCloud const& cloud, PointSubset subset, VirtualLight const& light,
                        HemisphereGrid grid, std::span<float> map, std::vector<float>& scratch);

/// A light whose map is asked.
struct MappedLight {
    vec3 position;
    Frame frame; ///< about its normal
    float const* map;
};

/// Whether a surface receives light. @param normal unit  @param slack m; a receiver may lie so much behind what
/// the map has, and by as much of its distance as a texel is wide
inline bool is_lit(MappedLight const& light, HemisphereGrid grid, vec3 position, vec3 normal, float slack)
{
    vec3 at = light.frame.to_local(position - light.position);
    at.z = std::max(at.z, 0.0f); // rounding
    vec2 const u = grid.square_from(at);
    int const x = grid.coordinate(u.x), y = grid.coordinate(u.y);
    // The receiver's own plane at the texel's centre, near where it is.
    float const own = HemisphereGrid::octahedral_distance(at);
    float const plane =
        glm::dot(normal, position - light.position) / glm::dot(normal, light.frame.to_world(grid.direction(x, y)));
    float const distance = plane > 0 && plane < 2 * own ? plane : own;
    float const there = light.map[y * int(grid.size) + x];
    return distance <= there + there * (2 / float(grid.size)) + slack;
}

} // namespace gi
