#pragma once
// Steps of a path by look-ups, the same on CPU and GPU: its start at the camera
// and its continuation along an axis.

#include "gi/hit_buffers/directions/axis_set.h"
#include "gi/hit_buffers/query.h"
#include "gi/raster/cut_outs.h"
#include "gi/render/path_step.h"

namespace gi {

/// Barycentric coordinates where a camera ray hits its triangle's plane, clamped to the triangle: the raster gives
/// the triangle, the ray the point.
GI_FN inline vec2 barycentric_of(Surface const& surface, Ray const& ray)
{
    vec3 const normal = glm::cross(surface.edge1, surface.edge2);
    float const t = glm::dot(normal, surface.corner - ray.origin) / glm::dot(normal, ray.direction);
    return std::isfinite(t) ? barycentric_at(surface, ray.origin + t * ray.direction) : vec2{1.0f / 3};
}

/// Scatters along a sampled axis by all non-delta lobes. Returns false if the path ends.
/// @param wo      towards the arrival, in at.frame  @param narrow  some lobe is sampled by exact rays
/// @param axis    the sampled one, unit; sampled.direction points along or against it
/// @param origin  set to the start of the look-up
GI_FN inline bool scatter_along(PathState& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                AxisSample const& sampled, Surface const& surface, std::uint32_t triangle,
                                vec3 axis, WalkOrigin& origin)
{
    vec3 const wi = at.frame.to_local(sampled.direction);
    float const side = glm::dot(sampled.direction, at.geometric_normal);
    if (!(wi.z > 0) || !(side > 0)) return false;
    BsdfValue const value = evaluate(at.bsdf, wo, wi);
    float const pdf = narrow ? value.pdf : wi.z * kInvPi;
    if (!(pdf > 0)) return false;
    s.throughput *= value.f * (wi.z * sampled.weight / pdf);
    s.arrival_pdf = pdf;
    vec3 const normal = glm::cross(surface.edge1, surface.edge2);
    origin = {at.position, triangle, glm::dot(normal, axis) > 0, glm::dot(sampled.direction, axis) > 0,
              std::sqrt(glm::max(0.0f, 1 - side * side)) / side};
    return true;
}

} // namespace gi
