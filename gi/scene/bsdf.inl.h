#pragma once
// Implementation of bsdf.h.

#include "gi/scene/fresnel.h"
#include "gi/scene/ggx.h"

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
    float const dielectric = 1 - f.metallic;
    b.diffuse = dielectric * (1 - f.transmission) * f.base_color;
    b.transmitted = dielectric * f.transmission * f.base_color;
    float const r = square((m.ior - 1) / (m.ior + 1));
    vec3 const coat_f0 = glm::min(r * f.specular_color, vec3{1}) * f.specular;
    b.coat_f0 = max_component(coat_f0);
    b.coat_f90 = f.specular;
    b.f0 = glm::mix(coat_f0, f.base_color, f.metallic);
    b.f90 = vec3{glm::mix(f.specular, 1.0f, f.metallic)};
    return b;
}

GI_FN inline Bsdf make_bsdf(Material const& m)
{
    return make_bsdf(m, {m.base_color, m.metallic, m.roughness, m.specular, m.specular_color, m.transmission});
}

namespace bsdf_detail {

/// The part of the light that passes the coat on the way in and out, so that base and coat together never reflect
/// more than they receive, and reciprocally (Shirley et al. 1997).
GI_FN inline float through_coat(Bsdf const& b, float cos_o, float cos_i)
{
    if (b.coat_f90 == 0) return 1;
    return (1 - schlick(b.coat_f0, b.coat_f90, cos_o)) * (1 - schlick(b.coat_f0, b.coat_f90, cos_i)) /
           (1 - schlick_mean(b.coat_f0, b.coat_f90));
}

GI_FN inline bool transmits(Bsdf const& b) { return max_component(b.transmitted) > 0; }

/// Probability of sampling the specular lobe rather than the diffuse one: by what each can reflect at most.
GI_FN inline float specular_share(Bsdf const& b, float cos_o)
{
    float diffuse = max_component(b.diffuse);
    float specular;
    if (b.model == MaterialModel::phong) {
        specular = max_component(b.phong_specular);
    } else if (transmits(b)) {
        specular = 1;
    } else {
        if (b.f90.x == 0) return 0;
        specular = max_component(schlick(b.f0, b.f90, cos_o));
        diffuse *= 1 - schlick(b.coat_f0, b.coat_f90, cos_o);
    }
    float const both = specular + diffuse;
    return both > 0 ? specular / both : 0;
}

GI_FN inline vec3 reflect(vec3 wo, vec3 h) { return 2 * glm::dot(wo, h) * h - wo; }
GI_FN inline vec3 mirror(vec3 wo) { return {-wo.x, -wo.y, wo.z}; }

GI_FN inline float phong_power(float cos_alpha, float exponent)
{
    return cos_alpha > 0 ? std::pow(cos_alpha, exponent) : (exponent == 0 ? 1.0f : 0.0f);
}

GI_FN inline bool specular_is_delta(Bsdf const& b)
{
    return b.model == MaterialModel::metal_rough && (transmits(b) || b.alpha < kSmoothAlpha);
}

/// The delta lobes: reflection, and transmission where there is one. @param share probability of being here
GI_FN inline BsdfSample sample_delta(Bsdf const& b, vec3 wo, bool front, float u, float share)
{
    BsdfSample s;
    s.delta = true;
    s.wi = mirror(wo);
    if (!transmits(b)) {
        s.weight = schlick(b.f0, b.f90, wo.z) / share;
        return s;
    }
    float const eta = front || b.thin ? 1 / b.ior : b.ior;
    DielectricInterface const face = fresnel_dielectric(wo.z, eta);
    float const reflectance = b.thin ? 2 * face.reflectance / (1 + face.reflectance) : face.reflectance;
    if (u < reflectance) {
        s.weight = vec3{1 / share};
        return s;
    }
    s.transmitted = true;
    s.weight = b.transmitted / share;
    if (b.thin) {
        s.wi = -wo;
    } else {
        s.wi = glm::normalize(vec3{-eta * wo.x, -eta * wo.y, -face.cos_transmitted});
        s.weight *= eta * eta;
    }
    return s;
}

} // namespace bsdf_detail

GI_FN inline bool only_delta(Bsdf const& b)
{
    bool const specular_seen = b.model == MaterialModel::phong ? max_component(b.phong_specular) > 0
                                                               : !bsdf_detail::specular_is_delta(b) && b.f90.x > 0;
    return !specular_seen && !(max_component(b.diffuse) > 0);
}

GI_FN inline vec3 evaluate(Bsdf const& b, vec3 wo, vec3 wi)
{
    using namespace bsdf_detail;
    if (!(wo.z > 0) || !(wi.z > 0)) return vec3{0};
    vec3 f = b.diffuse * kInvPi;
    if (b.model == MaterialModel::phong) {
        float const lobe = phong_power(glm::dot(mirror(wo), wi), b.phong_exponent);
        return f + b.phong_specular * ((b.phong_exponent + 1) * (0.5f * kInvPi) * lobe);
    }
    f *= through_coat(b, wo.z, wi.z);
    if (specular_is_delta(b) || b.f90.x == 0) return f;
    vec3 const h = glm::normalize(wo + wi);
    float const microfacets = ggx_normals(h, b.alpha) * ggx_visibility(wo.z, wi.z, b.alpha);
    return f + schlick(b.f0, b.f90, glm::dot(wo, h)) * microfacets;
}

GI_FN inline float pdf(Bsdf const& b, vec3 wo, vec3 wi)
{
    using namespace bsdf_detail;
    if (!(wo.z > 0) || !(wi.z > 0)) return 0;
    float const share = specular_share(b, wo.z);
    float density = (1 - share) * wi.z * kInvPi;
    if (share == 0 || specular_is_delta(b)) return density;
    if (b.model == MaterialModel::phong) {
        float const lobe = phong_power(glm::dot(mirror(wo), wi), b.phong_exponent);
        return density + share * (b.phong_exponent + 1) * (0.5f * kInvPi) * lobe;
    }
    return density + share * ggx_reflection_pdf(wo, glm::normalize(wo + wi), b.alpha);
}

GI_FN inline BsdfSample sample(Bsdf const& b, vec3 wo, bool front, float u_lobe, vec2 u)
{
    using namespace bsdf_detail;
    BsdfSample s;
    if (!(wo.z > 0)) return s;
    float const share = specular_share(b, wo.z);
    if (u_lobe < share) {
        if (specular_is_delta(b)) return sample_delta(b, wo, front, u_lobe / share, share);
        if (b.model == MaterialModel::phong) {
            float const cos_alpha = std::pow(1 - u.x, 1 / (b.phong_exponent + 1));
            float const sin_alpha = std::sqrt(glm::max(0.0f, 1 - cos_alpha * cos_alpha));
            s.wi = glm::normalize(Frame::about(mirror(wo)).to_world(vec3{sin_alpha * azimuth(u.y), cos_alpha}));
        } else {
            s.wi = reflect(wo, sample_ggx_normal(wo, b.alpha, u));
        }
    } else {
        s.wi = square_to_cosine_hemisphere(u);
        if (share == 0) {
            s.pdf = s.wi.z * kInvPi;
            s.weight = s.pdf > 0 ? b.diffuse * through_coat(b, wo.z, s.wi.z) : vec3{0};
            return s;
        }
    }
    s.pdf = pdf(b, wo, s.wi);
    if (s.pdf > 0) s.weight = evaluate(b, wo, s.wi) * (s.wi.z / s.pdf);
    return s;
}

} // namespace gi
