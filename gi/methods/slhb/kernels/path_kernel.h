#pragma once
// The paths of a pass by kernels: each launch moves all paths to their next surface,
// then only those that continue, so that the threads of a device do the same at the same time (Laine et al. 2013,
// "Megakernels Considered Harmful"). Estimators and random numbers are those of PathsTracer (tracer.h),
// so that both trace the same paths up to rounding.
//
// Mirrors, glass and narrow lobes continue by exact rays through the project's own BVH, traced by a kernel of
// their own (NearestHits). Cone, gathering, interleaving and shared vertices are not supported.

#include "gi/kernel/atomics.h"
#include "gi/hit_buffers/axis_step.h"
#include "gi/render/path_random.h"
#include "gi/hit_buffers/shadow_maps/shadow_look.h"
#include "gi/render/ray_kernels.h"
#include "gi/render/ray_path.h"
#include "gi/scene/shading/narrow_lobes.h"

namespace gi {

/// A LightPoint that kernels can read.
struct LightPointView {
    LightChoice choice;
    vec2 u{0};
    ShadowMapView shadow;
};

struct PathKernelCounts {
    std::uint64_t queries = 0, exact_rays = 0, shadow_lookups = 0;
    std::uint64_t doubtful_queries = 0, doubtful_shadows = 0; ///< of these look-ups, decided by exact rays
    std::uint64_t cut_paths = 0, invalid_paths = 0;

    PathKernelCounts& operator+=(PathKernelCounts const& o)
    {
        queries += o.queries;
        exact_rays += o.exact_rays;
        shadow_lookups += o.shadow_lookups;
        doubtful_queries += o.doubtful_queries;
        doubtful_shadows += o.doubtful_shadows;
        cut_paths += o.cut_paths;
        invalid_paths += o.invalid_paths;
        return *this;
    }
};

/// A path between two surfaces, and the next one if a look-up found it.
struct PathOnWay {
    PathState state;
    std::uint32_t pixel;
    int vertex; ///< as in StepPaths::State, like the following
    std::uint32_t triangle;
    float distance;
    vec3 position, direction;
};

/// Paths that continue.
struct PathsOnWay {
    ColumnView<PathOnWay> paths;
    ColumnView<RayQuery> queries; ///< of those whose surface an exact ray finds; no_query() for the others
    View<std::uint32_t> count;    ///< [0]
};

/// Light that arrives if a shadow ray is free, as the shadow map's texels disagree.
struct DoubtfulLight {
    RayQuery query; ///< no_query() = none
    vec3 light;
    std::uint32_t pixel;
    int scatterings; ///< of the light, see layer_of()
};

struct DoubtfulLights {
    ColumnView<DoubtfulLight> lights;
    View<std::uint32_t> count; ///< [0]
};

/// What the paths of a pass read and write.
struct PassOfPaths {
    WorldView world;
    CameraRays camera;
    View<NearestTexel const> primary; ///< per pixel, in rows of `width`
    View<std::uint8_t const> hidden;  ///< per pixel: 1 = hidden, nothing is traced; empty = none hidden
    vec2 place;                       ///< subpixel position, the same for all pixels
    std::uint32_t width;
    View<AxisView const> axes; ///< of all levels, see finest_slot()
    std::uint32_t axes_of_level;
    AxisChoice choice;
    View<LightPointView const> light_points;
    AliasTableView chances; ///< of the light points; empty = equal
    int bounces;
    float roulette; ///< see SlhbSettings
    bool smooth;    ///< the world contains a mirror or glass
    bool confirms;  ///< exact rays decide where look-ups and shadow maps are doubtful
    std::uint32_t seed, pass;
    std::size_t first;             ///< pixel of the first item of FirstSteps
    View<PathSample> samples;      ///< per pixel
    PathsOnWay next;               ///< to which paths are added
    DoubtfulLights doubtful;       ///< to which their light is added
    View<PathKernelCounts> counts; ///< to be added up
};

/// One step of paths. @tparam by_rays  some may need exact rays
template <bool by_rays>
struct StepPaths : PassOfPaths {
protected:
    /// State of one path.
    struct State : PathState {
        RqmcStream random;
        std::uint32_t triangle = kNoPrimitive;
        vec2 barycentric{1.0f / 3};
        vec3 position{0};            ///< only read where has_position
        bool has_position = false;   ///< found by a look-up, which gives the point instead of weights
        vec3 direction{0};           ///< of arrival
        float distance = 0;          ///< m, from the last surface
        int vertex = 0;              ///< number of surfaces before, delta lobes included
        RayQuery query = no_query(); ///< the exact ray that the path needs now
        DoubtfulLight doubtful{
            .query = no_query(), .light = vec3{0}, .pixel = 0, .scatterings = 0}; ///< at its last surface

        GI_FN std::uint32_t dimension(PathDimension d) const { return dimension_of(std::uint32_t(vertex), d); }
        GI_FN float number(PathDimension d) const { return random.sample(dimension(d)); }
    };

    GI_FN State start(std::size_t pixel) const;
    /// What the exact ray of the path found.
    GI_FN static void meet(State& s, Hit const& hit);
    /// From one surface to the next. Returns false if the path ends.
    GI_FN bool step(State& s, PathSample& out, PathKernelCounts& local) const;
    GI_FN vec3 sky(State const& s) const;
    GI_FN vec3 emission(State const& s, ShadingPoint const& at) const;
    GI_FN vec3 direct(State& s, ShadingPoint const& at, vec3 wo, bool narrow, PathKernelCounts& local) const;
    /// Keeps the light that waits for its shadow ray.
    GI_FN void wait(std::size_t pixel, State const& s) const;
    GI_FN void go_on(std::size_t pixel, State const& s) const;
    /// Continues the path to the next surface. Returns false if it ends.
    GI_FN bool scatter(State& s, ShadingPoint const& at, vec3 wo, bool narrow, PathKernelCounts& local) const;
    /// As scatter(), through a mirror, glass or a narrow lobe, by an exact ray.
    GI_FN bool scatter_by_ray(State& s, ShadingPoint const& at, vec3 wo, float u_lobe,
                              PathKernelCounts& local) const;
    /// Lets an exact ray find the next surface. Returns true.
    GI_FN bool follow_ray(State& s, ShadingPoint const& at, vec3 direction, PathKernelCounts& local) const;
    GI_FN bool scatter_by_look_up(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                  PathKernelCounts& local) const;
    GI_FN bool survives(State& s) const
    {
        return survives_roulette(s, roulette, [&s] { return s.number(PathDimension::roulette); });
    }
    /// True where only delta lobes continue; mirrors and glass do not count as scatterings.
    GI_FN bool is_last(State const& s) const { return s.scatterings > bounces; }
    /// True at the last scattering, where light samples must account for all light, see PathsTracer.
    GI_FN bool lit_alone(State const& s, bool narrow) const
    {
        return s.scatterings == bounces && !narrow && !smooth;
    }
    GI_FN void add_counts(std::size_t item, PathKernelCounts const& local) const;
};

/// Adds the light whose shadow ray is free. Item = the light.
struct AddDoubtfulLight {
    WorldView world;
    KernelRays rays;
    DoubtfulLights doubtful;
    View<PathSample> samples; ///< per pixel

    GI_FN void operator()(std::size_t i) const
    {
        if (i >= doubtful.count[0]) return;
        DoubtfulLight const d = doubtful.lights.load(i);
        if (!rays.occluded(world, d.query)) add_light(samples[d.pixel], d.scatterings, d.light);
    }
};

/// First step. Item = pixel, from `first` on.
template <bool by_rays>
struct FirstSteps : StepPaths<by_rays> {
    GI_FN void operator()(std::size_t i) const;
};

/// A further step, or with `last` all that are left: the last paths are too few to fill a device. Item = path.
template <bool by_rays, bool last>
struct FurtherSteps : StepPaths<by_rays> {
    PathsOnWay from;
    ColumnView<Hit> hits; ///< of from.queries
    KernelRays rays;      ///< for the last

    GI_FN void operator()(std::size_t i) const;
};

} // namespace gi

#include "gi/methods/slhb/kernels/path_kernel.inl.h"
