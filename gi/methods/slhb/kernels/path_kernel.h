#pragma once
// The paths of a pass as a kernel: item = pixel, one path depth first, its state in registers. The estimators are
// those of SlhbTracer (tracer.h) with the same random numbers, so that both trace the same paths but for rounding.
//
// What it lacks: exact rays. A path that chooses a mirror, glass or a narrow lobe ends there, and is counted; the
// light it would have brought is missing from the picture. Direct light on such surfaces has its full weight
// instead, as no exact ray will find the lamp. There is no cone, no gathering, no interleaving and no
// sharing of what layers send back.

#include "gi/kernel/atomics.h"
#include "gi/methods/slhb/directions/axis_set.h"
#include "gi/methods/slhb/hit_buffer/cut_outs.h"
#include "gi/methods/slhb/kernels/path_random.h"
#include "gi/methods/slhb/lights/shadow_look.h"
#include "gi/render/path_sample.h"
#include "gi/render/sampling.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/shading/light_sampling.h"
#include "gi/scene/shading/narrow_lobes.h"
#include "gi/scene/shading/shading_point.h"

namespace gi {

/// A Lamp that kernels can see.
struct LightPointView {
    LightChoice choice;
    vec2 u{0};
    ShadowMapView shadow;
};

struct PathKernelCounts {
    std::uint64_t queries = 0, shadow_lookups = 0;
    std::uint64_t narrow_ends = 0; ///< paths that wanted an exact ray
    std::uint64_t cut_paths = 0, invalid_paths = 0;
};

struct TracePaths {
    WorldView world;
    CameraRays camera;
    View<NearestTexel const> primary; ///< per pixel, in rows of `width`
    View<std::uint8_t const> hidden;  ///< per pixel: 1 = nobody sees it, and nothing is traced; empty = none
    vec2 place;                       ///< in the pixel, that all look through
    std::uint32_t width;
    View<AxisView const> axes;
    AxisChoice choice;
    View<LightPointView const> light_points;
    AliasTableView chances; ///< of the lamps; empty = equal
    int bounces;
    float roulette; ///< see SlhbSettings
    bool smooth;    ///< something in the world is a mirror or glass
    std::uint32_t seed, pass;
    View<PathSample> samples;      ///< per pixel
    View<PathKernelCounts> counts; ///< one

    GI_FN void operator()(std::size_t i) const;

private:
    /// One path on its way. Every surface scatters once, so that scatterings also count surfaces.
    struct State {
        RqmcStream random;
        std::uint32_t triangle = kNoPrimitive;
        vec2 barycentric{1.0f / 3};
        vec3 position{0};  ///< read after the first surface
        vec3 direction{0}; ///< of arrival
        vec3 throughput{1};
        float arrival_pdf = 0;    ///< of the direction, 1/sr; 0 = camera
        float distance = 0;       ///< that the last walk went, m
        bool meets_lamps = false; ///< lamps that the last walk met count
        int scatterings = 0;

        GI_FN std::uint32_t dimension(PathDimension d) const
        {
            return dimension_of(std::uint32_t(scatterings), d);
        }
    };

    GI_FN State start(std::size_t pixel) const;
    GI_FN vec3 sky(State const& s) const;
    GI_FN vec3 emission(State const& s, ShadingPoint const& at) const;
    GI_FN vec3 direct(State const& s, ShadingPoint const& at, vec3 wo, bool narrow, PathKernelCounts& local) const;
    /// False where the path ends.
    GI_FN bool leave(State& s, ShadingPoint const& at, vec3 wo, bool narrow, PathKernelCounts& local) const;
    /// Light samples find all light that the last surface gets, see SlhbTracer.
    GI_FN bool lit_alone(State const& s, bool narrow) const
    {
        return s.scatterings == bounces && !narrow && !smooth;
    }
    GI_FN static void add(PathSample& out, int scattered, vec3 radiance)
    {
        vec3& to = scattered == 0 ? out.radiance[0] : scattered == 1 ? out.radiance[1] : out.radiance[2];
        to += radiance;
    }
    GI_FN void add_counts(PathKernelCounts const& local) const;
};

} // namespace gi

#include "gi/methods/slhb/kernels/path_kernel.inl.h"
