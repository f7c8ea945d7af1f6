#pragma once
// The paths of a pass as a kernel: one item traces the whole path of one pixel, with its state in registers.
// Estimators and random numbers are those of SlhbTracer (tracer.h), so that both trace the same paths up to
// rounding.
//
// It has no exact rays. A path that chooses a mirror, glass or a narrow lobe ends there and is counted; its light
// is missing from the picture. Direct light on such surfaces gets its full weight instead, because no exact ray
// will find the light. Cone, gathering, interleaving and shared vertices are not supported.

#include "gi/kernel/atomics.h"
#include "gi/methods/slhb/kernels/axis_step.h"
#include "gi/methods/slhb/kernels/path_random.h"
#include "gi/methods/slhb/lights/shadow_look.h"
#include "gi/scene/shading/narrow_lobes.h"

namespace gi {

/// A LightPoint that kernels can read.
struct LightPointView {
    LightChoice choice;
    vec2 u{0};
    ShadowMapView shadow;
};

struct PathKernelCounts {
    std::uint64_t queries = 0, shadow_lookups = 0;
    std::uint64_t narrow_ends = 0; ///< paths that needed an exact ray
    std::uint64_t cut_paths = 0, invalid_paths = 0;
};

struct TracePaths {
    WorldView world;
    CameraRays camera;
    View<NearestTexel const> primary; ///< per pixel, in rows of `width`
    View<std::uint8_t const> hidden;  ///< per pixel: 1 = hidden, nothing is traced; empty = none hidden
    vec2 place;                       ///< subpixel position, the same for all pixels
    std::uint32_t width;
    View<AxisView const> axes;
    AxisChoice choice;
    View<LightPointView const> light_points;
    AliasTableView chances; ///< of the light points; empty = equal
    int bounces;
    float roulette; ///< see SlhbSettings
    bool smooth;    ///< the world contains a mirror or glass
    std::uint32_t seed, pass;
    View<PathSample> samples;      ///< per pixel
    View<PathKernelCounts> counts; ///< one

    GI_FN void operator()(std::size_t i) const;

private:
    /// State of one path; an arrival_pdf of 0 means the camera. Every surface scatters once, so that scatterings
    /// also count surfaces.
    struct State : PathState {
        RqmcStream random;
        std::uint32_t triangle = kNoPrimitive;
        vec2 barycentric{1.0f / 3};
        vec3 position{0};            ///< only read after the first surface
        vec3 direction{0};           ///< of arrival
        float distance = 0;          ///< length of the last walk, m
        bool counts_emission = true; ///< emission of the surface hit counts

        GI_FN std::uint32_t dimension(PathDimension d) const
        {
            return dimension_of(std::uint32_t(scatterings), d);
        }
    };

    GI_FN State start(std::size_t pixel) const;
    GI_FN vec3 sky(State const& s) const;
    GI_FN vec3 emission(State const& s, ShadingPoint const& at) const;
    GI_FN vec3 direct(State const& s, ShadingPoint const& at, vec3 wo, bool narrow, PathKernelCounts& local) const;
    /// Returns false if the path ends.
    GI_FN bool leave(State& s, ShadingPoint const& at, vec3 wo, bool narrow, PathKernelCounts& local) const;
    /// True at the last surface, where light samples must account for all light, see SlhbTracer.
    GI_FN bool lit_alone(State const& s, bool narrow) const
    {
        return s.scatterings == bounces && !narrow && !smooth;
    }
    GI_FN void add_counts(PathKernelCounts const& local) const;
};

} // namespace gi

#include "gi/methods/slhb/kernels/path_kernel.inl.h"
