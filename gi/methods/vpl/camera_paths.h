#pragma once
// Paths from the camera: they find the surfaces that virtual lights illuminate, and compute all other light.
//
// Of the light that a surface y sends directly to x, the first surface with non-delta scattering, virtual lights
// contribute the fraction
//   w(x, y) = min(1, b / h),  h = pi f_x |cos_x| |cos_y| / |x - y|^2,  b = 1 / near^2
// so that each contribution is bounded (Kollig and Keller 2004, sec. 3: "bias compensation"). These paths
// contribute the remaining 1 - w, which matters within about `near`, as well as direct light and light along
// mirrors and glass. No light is lost by clamping, and with exact visibility of virtual lights the sum is
// unbiased. f_x is the largest channel; cos_x uses the shading normal and cos_y the geometric one.

#include "gi/render/exact_visibility.h"
#include "gi/render/path_batch.h"

namespace gi {

/// h of the formula above, for one pair. @param value_x  pi * largest channel of f_x * |cos_x|
inline float bounded_term(float value_x, float cos_y, float squared_distance)
{
    return value_x * cos_y / squared_distance;
}
/// w of the formula above.
inline float share_of_virtual_lights(float h, float bound) { return h > bound ? bound / h : 1.0f; }

/// A surface that a camera path hit and that virtual lights illuminate.
struct Receiver {
    std::uint32_t path = 0; ///< index among the paths that advance together
    std::uint32_t triangle = 0;
    vec3 throughput{1}; ///< from the camera
    vec3 position;
    vec3 geometric_normal; ///< unit, towards the viewer
    Frame frame;           ///< about the shading normal, same side
    Bsdf bsdf;
    vec3 wo; ///< unit, local
    float clearance;
    bool front; ///< the viewer sees the counter-clockwise side
    bool matt;
};

struct CameraSubpath : RayPath {
    FirstHit first;
    bool straight = false; ///< arrives directly from the first surface with non-delta scattering
    float value_x = 0;     ///< at that surface, see bounded_term
};

struct CameraPaths {
    WorldView world;
    ExactVisibility const& visibility;
    CameraRays camera;
    int bounces;
    std::uint64_t seed;
    PixelFilter filter;
    int width;
    float bound; ///< b of the formula above, 1/m^2

    CameraSubpath start(int x, int y, std::uint32_t index) const;
    /// Traces all paths to their ends. @param receivers  appended, ordered by surface, then by path
    void trace(std::span<CameraSubpath> paths, std::vector<Receiver>& receivers, PathCounts& counts) const;

private:
    bool advance(CameraSubpath& p, Hit const& hit, int surface, std::uint32_t index,
                 std::vector<Receiver>& receivers, PathCounts& counts) const;
};

} // namespace gi
