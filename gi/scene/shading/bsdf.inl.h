#pragma once
// Implementation of bsdf.h.

#include "gi/scene/shading/fresnel.h"
#include "gi/scene/shading/ggx.h"

namespace gi {

GI_FN inline Bsdf make_bsdf(Material const& m, MaterialFactors const& f)
{
    Bsdf b;
    b.model = m.model;
    b.thin = m.thin;
    b.ior = m.ior;
    b.alpha = f.roughness * f.roughness;
    if (m.model == MaterialModel::phong) {
        b.diffuse = f.base_color;
        b.phong_specular = m.phong_specular;
        b.phong_exponent = m.phong_exponent;
        return b;
    }
    if (f.specular == 0 && f.metallic == 0 && f.transmission == 0) { // most surfaces of a room
        b.diffuse = f.base_color;
        return b;
    }
    float const opaque = (1 - f.metallic) * (1 - f.transmission);
    b.diffuse = opaque * f.base_color;
    b.clear = (1 - f.metallic) * f.transmission;
    b.transmitted = b.clear * f.base_color;
    float const r = square((m.ior - 1) / (m.ior + 1));
    vec3 const coat_f0 = glm::min(r * f.specular_color, vec3{1}) * f.specular;
    b.coat_f0 = max_component(coat_f0);
    b.coat_f90 = f.specular;
    b.f0 = opaque * coat_f0 + f.metallic * f.base_color;
    b.f90 = vec3{opaque * f.specular + f.metallic};
    return b;
}

GI_FN inline Bsdf make_bsdf(Material const& m)
{
    return make_bsdf(m, {m.base_color, m.metallic, m.roughness, m.specular, m.specular_color, m.transmission});
}

namespace bsdf_detail {

/// Fraction of light that passes the coat on the way in and out, such that base and coat together conserve energy
/// and are reciprocal (Shirley et al. 1997).
GI_FN inline float through_coat(Bsdf const& b, float cos_o, float cos_i)
{
    if (b.coat_f90 == 0) return 1;
    float const mean = 1 - schlick_mean(b.coat_f0, b.coat_f90);
    if (!(mean > 0)) return 0; // a coat that reflects everything
    return (1 - schlick(b.coat_f0, b.coat_f90, cos_o)) * (1 - schlick(b.coat_f0, b.coat_f90, cos_i)) / mean;
}

/// Probabilities of sampling each lobe; all zero if everything is black.
struct LobeChances {
    float clear = 0, specular = 0, diffuse = 0;
};

/// Probabilities in proportion to the maximum reflectance of each lobe.
GI_FN inline LobeChances lobe_chances(Bsdf const& b, float cos_o)
{
    float diffuse = max_component(b.diffuse);
    float specular = 0;
    if (b.model == MaterialModel::phong) {
        specular = max_component(b.phong_specular);
    } else if (b.f90.x > 0) {
        specular = max_component(schlick(b.f0, b.f90, cos_o));
        diffuse *= 1 - schlick(b.coat_f0, b.coat_f90, cos_o);
    }
    float const all = b.clear + specular + diffuse;
    if (!(all > 0)) return {};
    return {b.clear / all, specular / all, diffuse / all};
}

GI_FN inline vec3 reflect(vec3 wo, vec3 h) { return 2 * glm::dot(wo, h) * h - wo; }
GI_FN inline vec3 mirror(vec3 wo) { return {-wo.x, -wo.y, wo.z}; }

GI_FN inline float phong_power(float cos_alpha, float exponent)
{
    return cos_alpha > 0 ? std::pow(cos_alpha, exponent) : 0.0f;
}

GI_FN inline bool specular_is_delta(Bsdf const& b)
{
    return b.model == MaterialModel::metal_rough && b.alpha < kSmoothAlpha;
}

/// True if the surface has only a diffuse base, as most surfaces of most rooms.
GI_FN inline bool is_matt(Bsdf const& b)
{
    return b.model == MaterialModel::metal_rough && b.f90.x == 0 && b.clear == 0;
}

/// Smooth glass, or a thin sheet of it, met along wo.
struct GlassInterface {
    DielectricInterface face;
    float eta, reflectance; ///< reflectance: of a thin sheet, both of its faces together

    GI_FN GlassInterface(Bsdf const& b, vec3 wo, bool front)
        : face(fresnel_dielectric(wo.z, front || b.thin ? 1 / b.ior : b.ior)),
          eta(front || b.thin ? 1 / b.ior : b.ior),
          reflectance(b.thin ? 2 * face.reflectance / (1 + face.reflectance) : face.reflectance)
    {
    }
    /// @param chance  by which the weights are divided
    GI_FN BsdfSample reflected(Bsdf const& b, vec3 wo, float chance) const
    {
        BsdfSample s;
        s.delta = true;
        s.wi = mirror(wo);
        s.weight = vec3{b.clear / chance};
        return s;
    }
    GI_FN BsdfSample transmitted(Bsdf const& b, vec3 wo, float chance) const
    {
        BsdfSample s;
        s.delta = s.transmitted = true;
        s.weight = b.transmitted / chance;
        if (b.thin) {
            s.wi = -wo;
        } else {
            s.wi = glm::normalize(vec3{-eta * wo.x, -eta * wo.y, -face.cos_transmitted});
            s.weight *= eta * eta;
        }
        return s;
    }
};

/// Samples smooth glass or a thin sheet. @param chance probability of having chosen this lobe
GI_FN inline BsdfSample sample_clear(Bsdf const& b, vec3 wo, bool front, float u, float chance)
{
    GlassInterface const glass(b, wo, front);
    return u < glass.reflectance ? glass.reflected(b, wo, chance) : glass.transmitted(b, wo, chance);
}

/// Samples the specular lobe if it is not delta.
GI_FN inline vec3 sample_specular(Bsdf const& b, vec3 wo, vec2 u)
{
    if (b.model == MaterialModel::metal_rough) return reflect(wo, sample_ggx_normal(wo, b.alpha, u));
    float const cos_alpha = std::pow(1 - u.x, 1 / (b.phong_exponent + 1));
    float const sin_alpha = std::sqrt(glm::max(0.0f, 1 - cos_alpha * cos_alpha));
    return glm::normalize(Frame::about(mirror(wo)).to_world(vec3{sin_alpha * azimuth(u.y), cos_alpha}));
}

} // namespace bsdf_detail

GI_FN inline bool only_delta(Bsdf const& b)
{
    bool const specular_seen = b.model == MaterialModel::phong ? max_component(b.phong_specular) > 0
                                                               : !bsdf_detail::specular_is_delta(b) && b.f90.x > 0;
    return !specular_seen && !(max_component(b.diffuse) > 0);
}

GI_FN inline BsdfValue evaluate(Bsdf const& b, vec3 wo, vec3 wi)
{
    using namespace bsdf_detail;
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    if (is_matt(b)) return {b.diffuse * kInvPi, wi.z * kInvPi};
    LobeChances const chance = lobe_chances(b, wo.z);
    BsdfValue v{b.diffuse * kInvPi, chance.diffuse * wi.z * kInvPi};
    if (b.model == MaterialModel::phong) {
        float const lobe =
            (b.phong_exponent + 1) * (0.5f * kInvPi) * phong_power(glm::dot(mirror(wo), wi), b.phong_exponent);
        v.f += b.phong_specular * lobe;
        v.pdf += chance.specular * lobe;
        return v;
    }
    v.f *= through_coat(b, wo.z, wi.z);
    if (specular_is_delta(b) || b.f90.x == 0) return v;
    vec3 const h = glm::normalize(wo + wi);
    float const normals = ggx_normals(h, b.alpha);
    v.f += schlick(b.f0, b.f90, glm::dot(wo, h)) * (normals * ggx_visibility(wo.z, wi.z, b.alpha));
    v.pdf += chance.specular * ggx_reflection_pdf(wo, normals, b.alpha);
    return v;
}

GI_FN inline BsdfSample sample(Bsdf const& b, vec3 wo, bool front, float u_lobe, vec2 u)
{
    using namespace bsdf_detail;
    BsdfSample s;
    if (!(wo.z > 0)) return s;
    if (is_matt(b)) {
        s.wi = square_to_cosine_hemisphere(u);
        s.pdf = s.wi.z * kInvPi;
        if (s.pdf > 0) s.weight = b.diffuse;
        return s;
    }
    LobeChances const chance = lobe_chances(b, wo.z);
    if (u_lobe < chance.clear) return sample_clear(b, wo, front, u_lobe / chance.clear, chance.clear);
    if (u_lobe - chance.clear < chance.specular) {
        if (specular_is_delta(b)) {
            s.delta = true;
            s.wi = mirror(wo);
            s.weight = schlick(b.f0, b.f90, wo.z) / chance.specular;
            return s;
        }
        s.wi = sample_specular(b, wo, u);
    } else {
        s.wi = square_to_cosine_hemisphere(u);
    }
    BsdfValue const value = evaluate(b, wo, s.wi);
    s.pdf = value.pdf;
    if (s.pdf > 0) s.weight = value.f * (s.wi.z / s.pdf);
    return s;
}

GI_FN inline int delta_lobes(Bsdf const& b, vec3 wo, bool front, BsdfSample lobes[3])
{
    using namespace bsdf_detail;
    if (!(wo.z > 0)) return 0;
    int n = 0;
    if (b.clear > 0) {
        GlassInterface const glass(b, wo, front);
        if (glass.reflectance > 0) {
            lobes[n] = glass.reflected(b, wo, 1);
            lobes[n++].weight *= glass.reflectance;
        }
        if (glass.reflectance < 1) {
            lobes[n] = glass.transmitted(b, wo, 1);
            lobes[n++].weight *= 1 - glass.reflectance;
        }
    }
    if (specular_is_delta(b) && b.f90.x > 0) {
        lobes[n] = {};
        lobes[n].delta = true;
        lobes[n].wi = mirror(wo);
        lobes[n++].weight = schlick(b.f0, b.f90, wo.z);
    }
    return n;
}

} // namespace gi
