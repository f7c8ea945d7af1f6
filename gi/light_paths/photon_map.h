#pragma once
// Photon map (Jensen 1996): light that has reached surfaces, spread over disks. Each photon has a kernel of its
// own size: small ones in a bright line, large ones where light is thin.

#include "gi/light_paths/photon.h"

#include <span>
#include <vector>

namespace gi {

/// Radii of kernels are a largest one, halved so often.
struct KernelSizes {
    static constexpr int kLayers = 12; ///< different radii

    float largest;                   ///< m, > 0
    std::vector<std::uint8_t> layer; ///< per photon, below kLayers: how often it is halved

    float radius(std::size_t photon) const { return std::ldexp(largest, -int(layer[photon])); }
};

/// Of each photon the smallest kernel of whose area, as a cell of an octree about it, at least `enough` photons
/// are: follows the density that light has, also where it is focused.
KernelSizes sizes_by_density(std::span<Photon const> photons, float largest, std::size_t enough = 16);
/// Kernels with about `photons_each` photons by the paths' footprints (McGuire and Luebke 2009), which do not see
/// how curved mirrors and glass focus.
KernelSizes sizes_by_footprint(std::span<Photon const> photons, float largest, float photons_each);

/// What lies on the same surface as a photon. Kernels are flat, else the light of a table would lie on the paper
/// on it.
struct PhotonKernel {
    static constexpr float kSameWay = 0.8f;   ///< least cosine between normals
    static constexpr float kFromPlane = 0.2f; ///< greatest distance from the plane, radii

    /// Epanechnikov's kernel, 1/m^2; 0 outside. @param position, normal  of a surface
    GI_FN static float at(vec3 photon, vec3 photon_normal, float radius, vec3 position, vec3 normal)
    {
        vec3 const way = photon - position;
        float const share = 1 - glm::dot(way, way) / square(radius);
        if (!(share > 0) || glm::dot(photon_normal, normal) < kSameWay ||
            std::abs(glm::dot(way, normal)) > kFromPlane * radius)
            return 0;
        return share * (2 * kInvPi) / square(radius);
    }
};

/// Photons in cubic cells, by a hash of these.
class PhotonCells {
public:
    /// @param radius  of searches, m, > 0
    PhotonCells(std::vector<Photon> photons, float radius);

    float radius() const { return radius_; }
    std::size_t size() const { return photons_.size(); }
    /// Calls f(photon) for those that are nearer than the radius, and some others.
    template <class F>
    void search(vec3 position, F const& f) const;

private:
    std::uint32_t bucket(glm::ivec3 cell) const;
    glm::ivec3 cell_of(vec3 position) const;

    float radius_;
    vec3 low_{kInf}, high_{-kInf};     ///< of what may find photons
    std::vector<Photon> photons_;      ///< by the bucket of their cell, which is two radii wide
    std::vector<std::uint32_t> first_; ///< per bucket, and one more
};

class PhotonMap {
public:
    PhotonMap() = default;
    /// @param factor  of all radii
    PhotonMap(std::span<Photon const> photons, KernelSizes const& sizes, float factor = 1);

    /// Radiance that leaves towards wo by all non-delta lobes, W/(m^2 sr). @param wo  unit, in at.frame
    vec3 radiance(ShadingPoint const& at, vec3 wo) const;
    bool empty() const { return count_ == 0; }
    std::size_t count() const { return count_; }
    dvec3 flux() const { return flux_; } ///< W
    float mean_radius() const;           ///< m, over photons

private:
    std::vector<PhotonCells> layers_; ///< of kernels of one size each
    std::size_t count_ = 0;
    dvec3 flux_{0};
};

} // namespace gi
