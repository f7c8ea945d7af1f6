#pragma once
// Surfaces as points (Ritschel et al. 2008, sec. 3.1): each point represents
// the same area, as a disk in its surface.

#include "gi/methods/vpl/settings.h"
#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

#include <vector>

namespace gi {

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

} // namespace gi
