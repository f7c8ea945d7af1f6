#pragma once
// What the filters see of a picture: the surface at each pixel and the light that falls on it.

#include "gi/filter/denoise.h"
#include "gi/filter/filter_area.h"
#include "gi/filter/planes.h"

namespace gi {

/// Planes of the surfaces. Where there is none, or a black one, all are 0; a normal of 0 agrees with no other.
namespace guide {
enum : int {
    normal = 0,             ///< 3 planes
    position = 3,           ///< 3 planes, m, from a point of the scene
    inverse_footprint2 = 6, ///< 1 / (distance of neighbouring pixels)^2, 1/m2
    surface = 7,            ///< 1 where there is one
    variance = 8,           ///< of the luminance of all light
    albedo = 9,             ///< its luminance; apart by more than 1 where other channels are too dark
    count = 10
};
} // namespace guide

/// Planes of the light, all finite. Luminance and variance: first direct, then indirect.
namespace light {
enum : int {
    direct = 0,    ///< 3 planes, L1 over albedo
    indirect = 3,  ///< 3 planes, L2 over albedo
    luminance = 6, ///< 2 planes
    variance = 8,  ///< 2 planes, of the luminance
    count = 10
};
} // namespace light

struct FilterInput {
    Planes guides, light;  ///< the variance of the light is not filled in, but where it was measured
    bool measured = false; ///< by temporal reuse: light::variance has that of each pixel, negative = not known
    DenoiseReport report;
};

/// Of three channels. Throws InputError where it is missing.
Layer const& needed_layer(Picture const& picture, char const* name);
Layer& needed_layer(Picture& picture, char const* name);

/// Fills in what is near and reports what the filter has to find; footprints where they are wanted, and of all
/// that is near where variances were measured. Throws InputError where a layer is missing.
FilterInput make_filter_input(Picture const& picture, bool with_variance, FilterArea const& area);

inline constexpr float kLargest = 1e18f; ///< its square is still finite
/// False where a value is NaN or too large.
inline bool in_range(vec3 v)
{
    return std::abs(v.x) < kLargest && std::abs(v.y) < kLargest && std::abs(v.z) < kLargest;
}

/// Channels with less albedo tell nothing of the light: they keep their values, and so do pixels without any
/// other.
inline constexpr float kDarkest = 0.01f;

/// 0 in channels that are too dark.
inline vec3 over_albedo(vec3 value, vec3 albedo)
{
    return {albedo.x < kDarkest ? 0 : value.x / albedo.x, albedo.y < kDarkest ? 0 : value.y / albedo.y,
            albedo.z < kDarkest ? 0 : value.z / albedo.z};
}

} // namespace gi
