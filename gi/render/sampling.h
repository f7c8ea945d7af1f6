#pragma once
// Small parts of Monte Carlo estimators.

#include "gi/core/math.h"
#include "gi/render/render_settings.h"

#include <limits>

namespace gi {

/// Veach's power heuristic with exponent 2.
GI_FN inline float power_heuristic(float pdf, float other)
{
    float const ratio = other / pdf; // squaring the densities would overflow near small lights
    return 1.0f / (1.0f + ratio * ratio);
}

/// Filter importance sampling: where in the image plane the path of a pixel starts,
/// relative to the pixel's centre (px).
GI_FN inline vec2 filter_offset(PixelFilter filter, vec2 u)
{
    if (filter == PixelFilter::box) return u - 0.5f;
    if (filter == PixelFilter::centre) return vec2{0};
    auto const tent = [](float v) {
        return v < 0.5f ? std::sqrt(2 * v) - 1 : 1 - std::sqrt(std::max(0.0f, 2 - 2 * v));
    };
    return {tent(u.x), tent(u.y)};
}

/// Distance from which on camera rays see surfaces, m, so that a camera lying in a surface does not see only
/// that. Exceeds the rounding error of the distance to a plane through the camera.
GI_FN inline float camera_clearance(vec3 origin)
{
    return glm::max(2e-6f * max_component(glm::abs(origin)), std::numeric_limits<float>::min());
}

} // namespace gi
