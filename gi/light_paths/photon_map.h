#pragma once
// Photon map (Jensen 1996): light that has reached surfaces, spread over disks. Each photon has a kernel of its
// own size: small ones in a bright line, large ones where light is thin.

#include "gi/light_paths/photon.h"

#include <span>
#include <vector>

namespace gi {

/// Of each photon the radius of a kernel with at least about `enough` photons, m, by how many are in the cells of
/// octrees about it: follows the density that light has, also where it is focused. The mean of some octrees, each
/// shifted by a random vector, as radii that change in steps would show. Throws Interrupted.
std::vector<float> radii_by_density(std::span<Photon const> photons, float largest, std::size_t enough,
                                    std::uint64_t seed, BuildStop const& stop = BuildStop(nullptr));
/// Radii of kernels with about `photons_each` photons by the paths' footprints (McGuire and Luebke 2009), which do
/// not see how curved mirrors and glass focus, nor how lights share a surface.
std::vector<float> radii_by_footprint(std::span<Photon const> photons, float largest, float photons_each);

/// The area over which a photon's light is spread: other points of the same surface.
/// Kernels are flat, otherwise the light of a table would lie on the paper on it.
struct PhotonKernel {
    static constexpr float kSameWay = 0.8f;   ///< least cosine between normals
    static constexpr float kFromPlane = 0.2f; ///< greatest distance from the plane, radii

    vec3 position;        ///< m
    float radius;         ///< m
    vec3 normal;          ///< unit
    std::uint32_t photon; ///< its index

    /// Epanechnikov's kernel, 1/m^2; 0 outside.
    GI_FN float at(vec3 place, vec3 normal_there) const
    {
        vec3 const way = position - place;
        float const share = 1 - glm::dot(way, way) / square(radius);
        if (!(share > 0) || glm::dot(normal, normal_there) < kSameWay ||
            std::abs(glm::dot(way, normal_there)) > kFromPlane * radius)
            return 0;
        return share * (2 * kInvPi) / square(radius);
    }
};

/// Radiance that leaves a point towards wo, W/(m^2 sr), photon by photon:
/// by all its non-delta lobes, or without the glossy one.
struct PhotonSum {
    ShadingPoint const& at;
    vec3 wo; ///< unit, in at.frame
    bool matt, without_glossy;
    vec3 sum{0};

    GI_FN PhotonSum(ShadingPoint const& at_, vec3 wo_, bool without_glossy_)
        : at(at_), wo(wo_), matt(bsdf_detail::is_matt(at_.bsdf)), without_glossy(without_glossy_)
    {
    }
    GI_FN void add(PhotonKernel const& k, Photon const& p)
    {
        float const kernel = k.at(at.position, at.geometric_normal);
        if (!(kernel > 0)) return;
        vec3 const wi = at.frame.to_local(p.from), light = kernel * p.flux;
        if (matt) {
            if (wi.z > 0) sum += light;
            return;
        }
        vec3 f = evaluate(at.bsdf, wo, wi).f;
        if (without_glossy) f -= evaluate(glossy_lobe(at.bsdf), wo, wi).f;
        sum += light * glm::max(f, vec3{0});
    }
    GI_FN vec3 radiance() const { return matt ? kInvPi * at.bsdf.diffuse * sum : sum; }
};

/// Brings neighbours together in memory. Throws Interrupted.
void sort_along_curve(std::vector<Photon>& photons, BuildStop const& stop = BuildStop(nullptr));

/// Photons in cubic cells, by a hash of these.
class PhotonCells {
public:
    /// @param radius  of searches, m, > 0, as large as that of any kernel
    PhotonCells(std::span<PhotonKernel const> kernels, float radius);

    /// Calls f(kernel) for all kernels that reach a position, and for some others nearby.
    template <class F>
    void search(vec3 position, F const& f) const;

private:
    std::uint32_t bucket(glm::ivec3 cell) const;
    glm::ivec3 cell_of(vec3 position) const;

    float radius_;
    vec3 low_{kInf}, high_{-kInf};      ///< of what may find photons
    std::vector<PhotonKernel> kernels_; ///< by the bucket of their cell, which is two radii wide
    std::vector<std::uint32_t> first_;  ///< per bucket, and one more
};

class PhotonMap {
public:
    PhotonMap() = default;
    /// Throws Interrupted. @param photons  must outlive it  @param radii  of their kernels, m, > 0
    PhotonMap(std::span<Photon const> photons, std::span<float const> radii,
              BuildStop const& stop = BuildStop(nullptr));

    /// See PhotonSum.
    vec3 radiance(ShadingPoint const& at, vec3 wo, bool without_glossy) const;
    bool empty() const { return photons_.empty(); }
    std::size_t count() const { return photons_.size(); }
    dvec3 flux() const { return flux_; }                                                ///< W
    float mean_radius() const { return empty() ? 0 : float(radii_ / double(count())); } ///< m

private:
    std::vector<PhotonCells> layers_; ///< of kernels of similar size
    double radii_ = 0;                ///< sum, m
    std::span<Photon const> photons_;
    dvec3 flux_{0};
};

} // namespace gi
