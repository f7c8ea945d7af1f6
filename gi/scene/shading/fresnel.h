#pragma once
// Fresnel reflectance.

#include "gi/core/math.h"

namespace gi {

GI_FN inline float schlick_weight(float cos_theta)
{
    float const m = glm::clamp(1 - cos_theta, 0.0f, 1.0f);
    float const m2 = m * m;
    return m2 * m2 * m;
}

/// Schlick's approximation (1994).
template <class T>
GI_FN T schlick(T f0, T f90, float cos_theta)
{
    return f0 + (f90 - f0) * schlick_weight(cos_theta);
}

/// Mean reflectance under a uniform sky: 2 * integral of Schlick's reflectance times cos over cos.
template <class T>
GI_FN T schlick_mean(T f0, T f90)
{
    return f0 + (f90 - f0) * (1.0f / 21);
}

struct DielectricInterface {
    float reflectance;     ///< unpolarised, 1 on total internal reflection
    float cos_transmitted; ///< > 0; 0 on total internal reflection
};

/// Exact Fresnel equations. @param cos_incident in [0, 1]  @param eta n_incident / n_transmitted
GI_FN inline DielectricInterface fresnel_dielectric(float cos_incident, float eta)
{
    // In this order, equal media transmit everything at any angle.
    float const cos2_t = (1 - eta * eta) + square(eta * cos_incident);
    if (!(cos2_t > 0)) return {1, 0};
    float const cos_t = glm::min(std::sqrt(cos2_t), 1.0f);
    float const parallel = (cos_incident - eta * cos_t) / (cos_incident + eta * cos_t);
    float const perpendicular = (eta * cos_incident - cos_t) / (eta * cos_incident + cos_t);
    return {0.5f * (parallel * parallel + perpendicular * perpendicular), cos_t};
}

} // namespace gi
