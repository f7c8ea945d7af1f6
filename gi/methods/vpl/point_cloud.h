#pragma once
// Surfaces as points (Ritschel et al. 2008, sec. 3.1): each stands for the same area, as a disk in its surface.

#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

#include <vector>

namespace gi {

struct PointCloud {
    /// A power of two. Any 2^k points that start at a multiple of 2^k are spread evenly over the area (Sobol).
    static constexpr std::uint32_t kCount = std::uint32_t(kMostPoints);

    std::vector<vec3> position; ///< kCount, or none where there is no area
    std::vector<vec3> normal;   ///< unit, counter-clockwise side; 0 = alpha cut the point out
    double area_m2 = 0;         ///< of all surfaces
    /// Of the disks of n of them, m: together they have twice the area of all surfaces, and cover six sevenths of
    /// it, as they overlap.
    float disk_radius(std::uint32_t n) const { return float(std::sqrt(2 * area_m2 / (glm::pi<double>() * n))); }
};

PointCloud make_point_cloud(World const& world, std::uint64_t seed);

} // namespace gi
