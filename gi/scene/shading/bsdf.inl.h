#pragma once
// Implementation of bsdf.h.

#include "gi/scene/shading/fresnel.h"
#include "gi/scene/shading/ggx.h"
#include "gi/scene/shading/ggx_albedo.h"

namespace gi {

namespace bsdf_detail {

/// Light that metal facets reflect more than once leaves in all directions (Kulla and Conty 2017): f = again (1 - E(wo))
/// (1 - E(wi)) / pi, where E is what facets that reflect everything reflect once. With it, those lose nothing.
/// @param f0  reflectance of the facets at normal incidence, 1 at grazing
GI_FN inline vec3 reflected_again(vec3 f0, float alpha)
{
    constexpr float kLeast = 1e-4f; // of the light
    float const once = ggx_mean_albedo(alpha).sum(), rest = 1 - once;
    if (rest < kLeast || alpha < kSmoothAlpha) return vec3{0};
    vec3 const f = schlick_mean(f0, vec3{1});
    return f * f * once / ((vec3{1} - f * rest) * rest);
}

} // namespace bsdf_detail

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
    if (f.metallic > 0) b.again = f.metallic * bsdf_detail::reflected_again(f.base_color, b.alpha);
    return b;
}

GI_FN inline Bsdf make_bsdf(Material const& m)
{
    return make_bsdf(m, {m.base_color, m.metallic, m.roughness, m.specular, m.specular_color, m.transmission});
}

namespace bsdf_detail {

GI_FN inline bool specular_is_delta(Bsdf const& b)
{
    return b.model == MaterialModel::metal_rough && b.alpha < kSmoothAlpha;
}

/// How much of the light along a direction the microfacets reflect once, in parts of f0 and f90.
GI_FN inline GgxAlbedo facets_albedo(Bsdf const& b, float cosine)
{
    if (!specular_is_delta(b)) return ggx_albedo(cosine, b.alpha);
    float const grazing = schlick_weight(cosine);
    return {1 - grazing, grazing};
}

/// Fraction of light that passes the coat on the way in and out, such that base and coat together conserve energy
/// and are reciprocal (Shirley et al. 1997, with the reflectance of a rough coat).
/// @param once_o, once_i  facets_albedo of both directions
GI_FN inline float through_coat(Bsdf const& b, GgxAlbedo once_o, GgxAlbedo once_i)
{
    if (b.coat_f90 == 0) return 1;
    float const mean = 1 - (specular_is_delta(b) ? schlick_mean(b.coat_f0, b.coat_f90)
                                                 : ggx_mean_albedo(b.alpha).of(b.coat_f0, b.coat_f90));
    if (!(mean > 0)) return 0; // a coat that reflects everything
    return (1 - once_o.of(b.coat_f0, b.coat_f90)) * (1 - once_i.of(b.coat_f0, b.coat_f90)) / mean;
}

/// f of all that leaves in all directions alike: the base below the coat, and what metal facets reflect again.
GI_FN inline vec3 diffuse_value(Bsdf const& b, GgxAlbedo once_o, GgxAlbedo once_i)
{
    return kInvPi *
           (through_coat(b, once_o, once_i) * b.diffuse + (1 - once_o.sum()) * (1 - once_i.sum()) * b.again);
}

/// What diffuse_value makes of uniform light.
GI_FN inline vec3 diffuse_albedo(Bsdf const& b, GgxAlbedo once_o)
{
    vec3 base = b.diffuse * (1 - once_o.of(b.coat_f0, b.coat_f90));
    if (!(max_component(b.again) > 0)) return base;
    return base + (1 - once_o.sum()) * (1 - ggx_mean_albedo(b.alpha).sum()) * b.again;
}

/// Probabilities of sampling each lobe; all zero if everything is black.
struct LobeChances {
    float clear = 0, specular = 0, diffuse = 0;
};

/// Probabilities in proportion to the maximum reflectance of each lobe.
GI_FN inline LobeChances lobe_chances(Bsdf const& b, GgxAlbedo once_o)
{
    float diffuse = max_component(b.diffuse), specular = 0;
    if (b.model == MaterialModel::phong) {
        specular = max_component(b.phong_specular);
    } else if (b.f90.x > 0) {
        specular = max_component(once_o.of(b.f0, b.f90));
        diffuse = max_component(diffuse_albedo(b, once_o));
    }
    float const all = b.clear + specular + diffuse;
    if (!(all > 0)) return {};
    return {b.clear / all, specular / all, diffuse / all};
}
GI_FN inline LobeChances lobe_chances(Bsdf const& b, float cos_o)
{
    return lobe_chances(b, b.f90.x > 0 ? facets_albedo(b, cos_o) : GgxAlbedo{});
}

GI_FN inline vec3 reflect(vec3 wo, vec3 h) { return 2 * glm::dot(wo, h) * h - wo; }
GI_FN inline vec3 mirror(vec3 wo) { return {-wo.x, -wo.y, wo.z}; }

GI_FN inline float phong_power(float cos_alpha, float exponent)
{
    return cos_alpha > 0 ? std::pow(cos_alpha, exponent) : 0.0f;
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

GI_FN inline vec3 diffuse_albedo(Bsdf const& b, float cos_o)
{
    if (b.model == MaterialModel::phong || b.f90.x == 0) return b.diffuse;
    return bsdf_detail::diffuse_albedo(b, bsdf_detail::facets_albedo(b, cos_o));
}

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
    if (b.model == MaterialModel::phong) {
        LobeChances const chance = lobe_chances(b, GgxAlbedo{});
        BsdfValue v{b.diffuse * kInvPi, chance.diffuse * wi.z * kInvPi};
        float const lobe =
            (b.phong_exponent + 1) * (0.5f * kInvPi) * phong_power(glm::dot(mirror(wo), wi), b.phong_exponent);
        v.f += b.phong_specular * lobe;
        v.pdf += chance.specular * lobe;
        return v;
    }
    if (b.f90.x == 0) return {b.diffuse * kInvPi, lobe_chances(b, GgxAlbedo{}).diffuse * wi.z * kInvPi};
    GgxAlbedo const once_o = facets_albedo(b, wo.z), once_i = facets_albedo(b, wi.z);
    LobeChances const chance = lobe_chances(b, once_o);
    BsdfValue v{diffuse_value(b, once_o, once_i), chance.diffuse * wi.z * kInvPi};
    if (specular_is_delta(b)) return v;
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
