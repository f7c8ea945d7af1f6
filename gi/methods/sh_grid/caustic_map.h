#pragma once
// Photon map (Jensen 1996) of caustics: light that reached surfaces which are neither mirrors nor glass by way of
// such alone. Each photon lights a disk, so large that some others lie in it: small ones in a bright line, large
// ones where light is thin.

#include "gi/scene/shading/shading_point.h"

#include <span>
#include <vector>

namespace gi {

struct CausticPhoton {
    vec3 position;        ///< m
    vec3 normal;          ///< unit, geometric, on the lit side
    vec3 from;            ///< unit, towards where the light came from
    vec3 flux;            ///< W, with the correction for shading normals of LightVertex::power
    std::uint32_t target; ///< where its path began, see CausticTargets
};

/// Photons in cubic cells, by a hash of these.
class PhotonCells {
public:
    /// @param radius  of searches, m, > 0
    PhotonCells(std::vector<CausticPhoton> const& photons, float radius);

    float radius() const { return radius_; }
    std::size_t size() const { return photons_.size(); }
    /// Calls f(photon, square of its distance) for those that are nearer than the radius.
    template <class F>
    void search(vec3 position, F const& f) const;

private:
    std::uint32_t bucket(glm::ivec3 cell) const;
    glm::ivec3 cell_of(vec3 position) const;

    float radius_;
    vec3 low_{kInf}, high_{-kInf};       ///< of what may find photons
    std::vector<CausticPhoton> photons_; ///< by the bucket of their cell, which is two radii wide
    std::vector<std::uint32_t> first_;   ///< per bucket, and one more
};

struct CausticDisks {
    float largest;     ///< radius, m, > 0
    float factor = 1;  ///< of all radii
    bool same = false; ///< all have the largest
};

class CausticMap {
public:
    CausticMap() = default;
    CausticMap(std::vector<CausticPhoton> const& photons, CausticDisks const& disks);

    /// Radiance that leaves towards wo by all non-delta lobes, W/(m^2 sr). @param wo  unit, in at.frame
    vec3 radiance(ShadingPoint const& at, vec3 wo) const;
    bool empty() const { return count_ == 0; }
    std::size_t count() const { return count_; }
    dvec3 flux() const { return flux_; } ///< W
    float mean_radius() const;           ///< m, over photons

private:
    std::vector<PhotonCells> layers_; ///< of disks of one size each
    std::size_t count_ = 0;
    dvec3 flux_{0};
};

} // namespace gi
