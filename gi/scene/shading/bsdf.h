#pragma once
// Scattering at a point of a surface. Directions are unit vectors in the local shading frame, z = shading normal,
// both pointing away from the surface; wo is towards the viewer, wi towards the light. f is in 1/sr.
// Solid-angle measure throughout; perfect mirrors and smooth glass are delta lobes, handled only by `sample`.

#include "gi/scene/model/material.h"

namespace gi {

/// GGX alpha below which a lobe is a perfect mirror (roughness < 0.01).
inline constexpr float kSmoothAlpha = 1e-4f;

/// Scattering parameters at one point: a material with its textures evaluated.
///   metal_rough: the diffuse base below a Schlick coat + GGX reflection with Fresnel f0..f90, by metals also more than
///     once; a share `clear` of the surface is smooth dielectric instead (exact Fresnel, roughness ignored)
///   phong: Lambert + Phong lobe
struct Bsdf {
    MaterialModel model = MaterialModel::metal_rough;
    bool thin = true;
    vec3 diffuse{0};    ///< albedo of the base, already times (1 - metallic)(1 - transmission)
    vec3 f0{0}, f90{0}; ///< reflectance at normal and grazing incidence, times 1 - clear; 0 = no specular lobe
    float coat_f0 = 0, coat_f90 = 0; ///< the same of the dielectric coat over the base, largest channel
    float alpha = 1;                 ///< GGX width; < kSmoothAlpha: delta
    vec3 again{0}; ///< what metal facets reflect more than once, over (1 - E(wo)) (1 - E(wi)), see bsdf.inl.h
    float clear = 0;                 ///< share that is glass, (1 - metallic) transmission; 0 = opaque
    vec3 transmitted{0};             ///< tint of transmitted light, times clear
    float ior = 1.5f;                ///< inside over outside, seen from the front face
    vec3 phong_specular{0};
    float phong_exponent = 1;
};

/// Factors of a material at one point: its own values times its textures.
struct MaterialFactors {
    vec3 base_color;
    float metallic, roughness, specular;
    vec3 specular_color;
    float transmission;
};

/// glTF 2 appendix B with KHR_materials_specular, _ior and _transmission.
GI_FN Bsdf make_bsdf(Material const& material, MaterialFactors const& factors);
/// Same for a material without textures.
GI_FN Bsdf make_bsdf(Material const& material);

struct BsdfSample {
    vec3 wi{0};
    vec3 weight{0}; ///< f |cos| / pdf (for delta lobes the same limit); 0 = the path ends
    float pdf = 0;  ///< of wi over all non-delta lobes together, 1/sr; 0 for delta
    bool delta = false;
    bool transmitted = false;
};

struct BsdfValue {
    vec3 f{0}; ///< of all non-delta lobes, 1/sr
    /// Density with which `sample` draws wi through one of them (with its selection probability), 1/sr.
    float pdf = 0;
};

GI_FN BsdfValue evaluate(Bsdf const& bsdf, vec3 wo, vec3 wi);
/// @param front  wo is on the front face (determines which side of a dielectric is the inside)
/// @param u_lobe selects the lobe, u the direction; uniform in [0, 1)
GI_FN BsdfSample sample(Bsdf const& bsdf, vec3 wo, bool front, float u_lobe, vec2 u);
/// The delta lobes' directions, each with all of its light; pdf and chances do not matter. Returns their number.
GI_FN int delta_lobes(Bsdf const& bsdf, vec3 wo, bool front, BsdfSample lobes[3]);
/// Reflectance of uniform light, towards a direction, by what leaves in all directions alike: the base below its coat, and
/// what metal facets reflect more than once.
GI_FN vec3 diffuse_albedo(Bsdf const& bsdf, float cos_o);
/// The glossy lobe of a surface alone.
GI_FN inline Bsdf glossy_lobe(Bsdf const& b)
{
    Bsdf lobe = b;
    lobe.diffuse = lobe.again = vec3{0};
    lobe.clear = 0;
    return lobe;
}
/// True when every lobe is delta or black, so that sampling lights is useless.
GI_FN bool only_delta(Bsdf const& bsdf);

} // namespace gi

#include "gi/scene/shading/bsdf.inl.h"
