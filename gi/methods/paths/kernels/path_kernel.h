#pragma once
// The paths of a pass by kernels, of the methods paths and slhb: each launch moves all paths to their next surface,
// then only those that continue, so that the threads of a device do the same at the same time (Laine et al. 2013,
// "Megakernels Considered Harmful"). Estimators and random numbers are those of PathsTracer (tracer.h),
// so that both trace the same paths up to rounding.
//
// Exact rays through the project's own BVH are traced by a kernel of their own (RaysOfSteps): all of paths, those of
// mirrors, glass and narrow lobes of slhb, and what is doubtful there. Cone, gathering, interleaving, shared vertices,
// and the radiance cache for slhb are not supported.

#include "gi/hit_buffers/axis_step.h"
#include "gi/hit_buffers/shadow_maps/shadow_look.h"
#include "gi/kernel/atomics.h"
#include "gi/methods/paths/kernels/cache_kernels.h"
#include "gi/methods/paths/light_pool.h"
#include "gi/render/path_random.h"
#include "gi/render/ray_kernels.h"
#include "gi/render/ray_path.h"
#include "gi/render/sampling.h"
#include "gi/scene/shading/narrow_lobes.h"

namespace gi {

/// A LightPoint that kernels can read.
struct LightPointView {
    LightChoice choice;
    vec2 u{0};
    ShadowMapView shadow;
};

struct PathKernelCounts {
    std::uint64_t queries = 0, exact_rays = 0, shadow_lookups = 0, shadow_rays = 0, cache_reads = 0;
    std::uint64_t doubtful_queries = 0, doubtful_shadows = 0; ///< of these look-ups, decided by exact rays
    std::uint64_t cut_paths = 0, invalid_paths = 0;

    PathKernelCounts& operator+=(PathKernelCounts const& o)
    {
        queries += o.queries;
        exact_rays += o.exact_rays;
        shadow_lookups += o.shadow_lookups;
        shadow_rays += o.shadow_rays;
        cache_reads += o.cache_reads;
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
    float footprint; ///< approximate width of the bundle of paths that this one represents, m
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

/// Light that arrives as far as a shadow ray is free: of paths always, of slhb where the shadow map's texels disagree.
struct WaitingLight {
    RayQuery query; ///< no_query() = none
    vec3 light;
    std::uint32_t pixel;
    int scatterings; ///< of the light, see layer_of()
};

struct WaitingLights {
    ColumnView<WaitingLight> lights;
    View<std::uint32_t> count; ///< [0]
};

/// What the paths of a pass read and write.
struct PassOfPaths {
    WorldView world;
    CameraRays camera;
    View<NearestTexel const> primary; ///< per pixel, in rows of `width`; empty = StartRays
    View<std::uint8_t const> hidden;  ///< per pixel: 1 = hidden, nothing is traced; empty = none hidden
    vec2 place;                       ///< subpixel position, the same for all pixels of `primary`
    PixelFilter filter;               ///< of StartRays
    std::size_t pixels;
    std::uint32_t width;
    View<AxisView const> axes; ///< of all levels, see finest_slot()
    std::uint32_t axes_of_level;
    AxisChoice choice;
    View<LightPointView const> light_points;
    AliasTableView chances; ///< of the light points; empty = equal
    LightPoolView pool;     ///< in place of light points
    CacheView cache;        ///< in whose cells paths by rays may end
    int bounces;
    float roulette; ///< see SlhbSettings
    bool smooth;    ///< the world contains a mirror or glass
    bool meets_light; ///< paths can hit light: a sky or emissive surfaces
    bool confirms;  ///< exact rays decide where look-ups and shadow maps are doubtful
    std::uint32_t seed, pass;
    std::size_t first; ///< of FirstSteps or StartRays: what is before their first item, see pixel_of
    View<std::uint32_t const>
        blocks;                    ///< of kPixelsOfTurn pixels, in the order of their turns; empty = as they are
    View<PathSample> samples;      ///< per pixel
    PathsOnWay next;               ///< to which paths are added
    WaitingLights waiting;         ///< to which their light is added
    View<PathKernelCounts> counts; ///< to be added up

    /// May be beyond the last pixel.
    GI_FN std::size_t pixel_of(std::size_t item) const
    {
        std::size_t const at = first + item;
        return blocks.empty() ? at : blocks[at / kPixelsOfTurn] * kPixelsOfTurn + at % kPixelsOfTurn;
    }
};

/// How paths find surfaces and whether light samples are visible.
enum class FindBy : std::uint8_t {
    look_ups,          ///< along axes, and by shadow maps
    look_ups_and_rays, ///< exact rays too, by mirrors, glass and narrow lobes, and where look-ups are doubtful
    rays               ///< each path in its own directions, and to light samples of a pool
};

/// One step of paths.
template <FindBy by>
struct StepPaths : PassOfPaths {
    static constexpr bool by_rays = by != FindBy::look_ups, free = by == FindBy::rays;

protected:
    static constexpr std::uint32_t kNoNote = 0xffffffffu;
    /// State of one path.
    struct State : PathState {
        RqmcStream random;
        std::uint32_t triangle = kNoPrimitive;
        vec2 barycentric{1.0f / 3};
        vec3 position{0};            ///< only read where has_position
        bool has_position = false;   ///< found by a look-up, which gives the point instead of weights
        vec3 direction{0};           ///< of arrival
        float distance = 0;          ///< m, from the last surface
        float footprint = 0;         ///< as in PathOnWay
        std::uint32_t note = kNoNote; ///< index of the note about its surface
        int vertex = 0;              ///< number of surfaces before, delta lobes included
        RayQuery query = no_query(); ///< the exact ray that the path needs now
        WaitingLight waiting{
            .query = no_query(), .light = vec3{0}, .pixel = 0, .scatterings = 0}; ///< at its last surface

        GI_FN std::uint32_t dimension(PathDimension d) const { return dimension_of(std::uint32_t(vertex), d); }
        GI_FN float number(PathDimension d) const { return random.sample(dimension(d)); }
    };

    GI_FN State start(std::size_t pixel) const;
    /// What the exact ray of the path found.
    GI_FN static void meet(State& s, Hit const& hit);
    /// True if the path ends in the cell of its surface, whose light is added; else it may have a note to teach it.
    /// @param indirect  light of the path so far, more than once scattered
    GI_FN bool ends_in_cell(State& s, std::size_t pixel, vec3 indirect, PathSample& out) const;
    GI_FN CacheKeys keys_of(State const& s) const;
    /// From one surface to the next. Returns false if the path ends.
    GI_FN bool step(State& s, PathSample& out, PathKernelCounts& local) const;
    GI_FN vec3 sky(State const& s) const;
    GI_FN vec3 emission(State const& s, ShadingPoint const& at) const;
    GI_FN vec3 direct(State& s, ShadingPoint const& at, vec3 wo, bool narrow, PathKernelCounts& local) const;
    /// The same, of a light sample of the pool, whose shadow ray waits.
    GI_FN vec3 pooled(State& s, ShadingPoint const& at, vec3 wo, bool narrow, PathKernelCounts& local) const;
    GI_FN RayQuery shadow_query(State const& s, ShadingPoint const& at, LightSample const& light) const;
    /// Keeps the light that waits for its shadow ray.
    GI_FN void wait(std::size_t pixel, State const& s) const;
    /// Returns its place in `next`.
    GI_FN std::uint32_t go_on(std::size_t pixel, State const& s) const;
    /// Continues the path to the next surface. Returns false if it ends.
    GI_FN bool scatter(State& s, ShadingPoint const& at, vec3 wo, bool narrow, PathKernelCounts& local) const;
    /// As scatter(), through a mirror, glass or a narrow lobe, by an exact ray.
    GI_FN bool scatter_by_ray(State& s, ShadingPoint const& at, vec3 wo, float u_lobe,
                              PathKernelCounts& local) const;
    /// Lets an exact ray find the next surface. Returns true.
    GI_FN bool follow_ray(State& s, ShadingPoint const& at, vec3 direction, PathKernelCounts& local) const;
    GI_FN bool scatter_by_look_up(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                  PathKernelCounts& local) const;
    /// Into a cosine-distributed direction.
    GI_FN bool scatter_freely(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
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

/// Exact rays between two steps: to the next surfaces of paths, then to the light that waited at the last ones, which
/// is added if nothing is in its way. In one launch, so that a device is not left idle between them.
/// @tparam panes  see KernelRays::transmittance
template <bool panes>
struct RaysOfSteps {
    WorldView world;
    KernelRays rays;
    std::size_t nearest; ///< items for queries; the further ones are for light
    ColumnView<RayQuery> queries;
    View<std::uint32_t const> count; ///< [0]: of queries
    ColumnView<Hit> hits;            ///< of queries
    WaitingLights waiting;
    View<PathSample> samples; ///< per pixel

    GI_FN void operator()(std::size_t i) const
    {
        if (i < nearest) {
            if (i >= count[0]) return;
            RayQuery const q = queries.load(i);
            if (q.reach > 0) hits.store(i, rays.nearest(world, q));
            return;
        }
        if (i - nearest >= waiting.count[0]) return;
        WaitingLight const w = waiting.lights.load(i - nearest);
        vec3 const left = rays.transmittance<panes>(world, w.query);
        if (left != vec3{0}) add_light(samples[w.pixel], w.scatterings, left * w.light);
    }
};

/// Rays of the camera to first surfaces, each through its own place in the pixel and on the lens. Item: see pixel_of.
struct StartRays : StepPaths<FindBy::rays> {
    KernelRays rays;
    ColumnView<Hit> hits; ///< of next.queries

    GI_FN void operator()(std::size_t i) const;
};

/// First step. Item: see pixel_of.
template <FindBy by>
struct FirstSteps : StepPaths<by> {
    GI_FN void operator()(std::size_t i) const;
};

/// A further step, or with `last` all that are left: the last paths are too few to fill a device. Item = path.
template <FindBy by, bool last>
struct FurtherSteps : StepPaths<by> {
    PathsOnWay from;
    ColumnView<Hit> hits; ///< of from.queries
    KernelRays rays;      ///< for the last

    GI_FN void operator()(std::size_t i) const;
};

} // namespace gi

#include "gi/methods/paths/kernels/path_kernel.inl.h"
