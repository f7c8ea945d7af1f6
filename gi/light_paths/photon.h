#pragma once
// Photons: light that has reached a surface, as photon maps store it (Jensen 1996;
// Norén and Sjölin 2010, table 3).

#include "gi/light_paths/light_paths.h"
#include "gi/scene/shading/narrow_lobes.h"

namespace gi {

struct Photon {
    vec3 position;   ///< m
    vec3 normal;     ///< unit, geometric, on the lit side
    vec3 from;       ///< unit, towards where the light came from
    vec3 flux;       ///< W, with the correction for shading normals of LightVertex::power
    vec3 reflected;  ///< share of the flux that leaves by broad lobes, as radiant exitance
    float footprint; ///< see LightVertex
    std::uint32_t triangle;
    std::uint32_t path;        ///< see LightVertex
    std::uint16_t scatterings; ///< see LightVertex
    bool by_delta;             ///< see LightVertex
    bool front;                ///< it lies on the counter-clockwise side
};

/// Share of light at an angle that leaves by lobes which are not narrow.
inline vec3 broad_reflectance(Bsdf const& b, float cosine)
{
    vec3 const diffuse = diffuse_albedo(b, cosine);
    if (has_narrow_lobe(b)) return diffuse;
    if (b.model == MaterialModel::phong) return diffuse + b.phong_specular;
    return diffuse + (b.f90.x > 0 ? bsdf_detail::facets_albedo(b, cosine).of(b.f0, b.f90) : vec3{0});
}

inline Photon to_photon(LightVertex const& v)
{
    return {v.position,
            v.normal,
            v.frame.to_world(v.arrived),
            v.power,
            broad_reflectance(v.bsdf, v.arrived.z),
            v.footprint,
            v.triangle,
            v.path,
            std::uint16_t(v.scatterings),
            v.by_delta,
            v.front};
}

} // namespace gi
