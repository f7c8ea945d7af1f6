#pragma once
// Input of the filters: the surface at each pixel and the light that falls on it.

#include "gi/filter/denoise.h"
#include "gi/filter/filter_area.h"
#include "gi/filter/planes.h"

namespace gi {

/// Planes of the surfaces. All are 0 if a pixel has no surface or a black one; a normal of 0 agrees with no other.
namespace guide {
enum : int {
    normal = 0,             ///< 3 planes
    position = 3,           ///< 3 planes, m, from a point of the scene
    inverse_footprint2 = 6, ///< 1 / (distance of neighbouring pixels)^2, 1/m2
    surface = 7,            ///< 1 if the pixel has a surface
    variance = 8,           ///< of the luminance of all light
    /// Its luminance, offset so that surfaces with different channels too dark differ by more than 1.
    albedo = 9,
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
    Planes guides, light;  ///< the variance of the light is filled in only if it was measured
    bool measured = false; ///< by temporal reuse: light::variance holds each pixel's variance, negative = unknown
    DenoiseReport report;
    StopRequest const* stop = nullptr; ///< of the settings
};

/// Returns a layer of three channels. Throws InputError if it is missing.
Layer const& needed_layer(Picture const& picture, char const* name);
Layer& needed_layer(Picture& picture, char const* name);

/// Fills in all near pixels and makes the report for the wanted ones. Footprints are set for wanted pixels, or
/// for all near pixels if variances were measured. Throws InputError if a layer is missing.
FilterInput make_filter_input(Picture const& picture, bool with_variance, FilterArea const& area,
                              StopRequest const* stop = nullptr);

inline constexpr float kLargest = 1e18f; ///< its square is still finite
/// False if a value is NaN or too large.
inline bool in_range(vec3 v)
{
    return std::abs(v.x) < kLargest && std::abs(v.y) < kLargest && std::abs(v.z) < kLargest;
}

/// Smallest albedo that light is divided by. Darker channels are not filtered: they leave a filter as they came.
inline constexpr float kDarkest = 0.01f;

/// Returns value / albedo, 0 in channels that are too dark.
inline vec3 over_albedo(vec3 value, vec3 albedo)
{
    return {albedo.x < kDarkest ? 0 : value.x / albedo.x, albedo.y < kDarkest ? 0 : value.y / albedo.y,
            albedo.z < kDarkest ? 0 : value.z / albedo.z};
}

/// Light over albedo; channels that are too dark keep their values.
inline vec3 light_over(vec3 light, vec3 albedo)
{
    for (int c = 0; c < 3; ++c)
        if (albedo[c] >= kDarkest) light[c] /= albedo[c];
    return light;
}

/// The reverse of light_over().
inline vec3 light_times(vec3 light, vec3 albedo)
{
    for (int c = 0; c < 3; ++c)
        if (albedo[c] >= kDarkest) light[c] *= albedo[c];
    return light;
}

} // namespace gi
