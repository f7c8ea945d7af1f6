#pragma once
// Photon map (Jensen 1996) of caustics: light that reached surfaces which are neither mirrors nor glass by way of
// such alone. Their radiance is estimated by the density of photons in a disk.

#include "gi/scene/shading/shading_point.h"

#include <span>
#include <vector>

namespace gi {

struct CausticPhoton {
    vec3 position; ///< m
    vec3 normal;   ///< unit, geometric, on the lit side
    vec3 from;     ///< unit, towards where the light came from
    vec3 flux;     ///< W, with the correction for shading normals of VirtualLight::power
};

class CausticMap {
public:
    CausticMap() = default;
    /// @param radius  of the disks, m, > 0
    CausticMap(std::vector<CausticPhoton> photons, float radius);

    /// Radiance that leaves towards wo by all non-delta lobes, W/(m^2 sr). @param wo  unit, in at.frame
    vec3 radiance(ShadingPoint const& at, vec3 wo) const;
    std::span<CausticPhoton const> photons() const { return photons_; }
    float radius() const { return radius_; } ///< m

private:
    std::uint32_t bucket(glm::ivec3 cell) const;
    glm::ivec3 cell_of(vec3 position) const;

    std::vector<CausticPhoton> photons_; ///< by the bucket of their cell, which is two radii wide
    std::vector<std::uint32_t> first_;   ///< per bucket, and one more
    float radius_ = 1;
};

/// Radius in which the median photon has about `neighbours` others, from a sample of them; m, 0 if there are no
/// two.
float median_radius(std::span<CausticPhoton const> photons, int neighbours);

} // namespace gi
