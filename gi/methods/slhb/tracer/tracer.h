#pragma once
// Paths through layered hit buffers. Primary surfaces come from a G-buffer, direct light from shadow maps; a
// diffuse or broad lobe continues along one of the axes of the pass (hemisphere formulation, Yu 2012, eq. 5.7), a
// mirror, glass or narrow lobe with an exact ray. Paths of a block advance together, one surface at a time: all
// shadings, then all queries.
//
// Estimators. Axis k is drawn with chance p_k in proportion to solid angle times cosine; the factor of a path is
// f cos w_k / p_k, times the balance heuristic against the narrow lobes where there are some (one-sample model,
// Veach 1997, sec. 9.2.4). Lamps are found by light sampling alone, except by exact rays; the sky by both, with
// the power heuristic.

#include "gi/core/rqmc.h"
#include "gi/methods/slhb/directions/axis_set.h"
#include "gi/methods/slhb/lights/light_points.h"
#include "gi/methods/slhb/tracer/radiance_cache.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/interleaving.h"
#include "gi/render/path_sample.h"
#include "gi/render/render_settings.h"

#include <span>

namespace gi {

/// Work done, for --stats.
struct SlhbCounts {
    std::uint64_t queries = 0, exact_rays = 0, shadow_lookups = 0, shadow_rays = 0, cache_reads = 0;
    double direct_s = 0, indirect_s = 0; ///< of all threads: first surfaces with their direct light; what follows
};

/// Where a path begins: at what the camera sees, or on a layer that several paths have met.
struct PathStart {
    std::uint32_t stream;   ///< of random numbers; the pixel
    std::uint32_t triangle; ///< kNoPrimitive = none
    Ray ray;                ///< that arrived; from a layer, its origin is the point on the triangle
    bool on_layer = false;  ///< the first scattering has been
};

/// The rest of a path that ends on a matt surface: what is sent back from there is the same for all paths that met
/// the same side of a layer.
struct SharedVertex {
    std::uint32_t triangle = kNoLayerHit; ///< kNoLayerHit = the path does not end so
    std::uint32_t layer = kNoLayerHit;    ///< of the pool
    bool up = false;                      ///< the walk that met the layer
    vec3 position{0};
    vec3 arrival{0}; ///< direction of the path
    vec3 throughput{0};
};

/// Where the ray of a start from the camera meets the plane of its triangle.
inline vec2 barycentric_of(Surface const& surface, Ray const& ray)
{
    vec3 const normal = glm::cross(surface.edge1, surface.edge2);
    float const t = glm::dot(normal, surface.corner - ray.origin) / glm::dot(normal, ray.direction);
    return std::isfinite(t) ? barycentric_at(surface, ray.origin + t * ray.direction) : vec2{1.0f / 3};
}

/// What a path along an axis finds where it meets nothing.
struct SkyAlong {
    vec3 radiance;
    float pdf; ///< of light sampling, 1/sr
};
/// Of all axes: against each of them, then along it.
std::vector<SkyAlong> sky_along(AxisSet const& axes, World const& world);

class SlhbTracer {
public:
    /// What stays the same over a pass. `exact` may be null where needs_exact_rays says that nothing asks it.
    struct Pass {
        AxisSet const& axes;
        LightPoints const& light_points;
        ExactVisibility const* exact;
        std::uint32_t index;       ///< of the path of each pixel
        std::uint32_t gather_axis; ///< taken by every first bounce; kNoPrimitive = by chance
        /// Triangle: samples say whether one from here on may count in them. As many as there are: not asked.
        std::uint32_t first_watched = kNoPrimitive;
        RayWorld exact_world = RayWorld::all;
        std::span<SkyAlong const> sky = {}; ///< along the axes; may be empty
        LightPool const* lights = nullptr;  ///< paths send exact rays to these; null = they have `lamps`
        bool smooth = false;                ///< something in the world is a mirror or glass
        bool look_ups = true;               ///< else exact rays in their place
        RadianceCache* cache = nullptr;     ///< paths may end in its cells; null = all go on to their end
        bool spread = false;                ///< pixels that wait for indirect light will get that of others
    };

    /// @param width  of the picture, pixels
    SlhbTracer(World const& world, CameraRays const& camera, int width, RenderSettings const& settings,
               SlhbSettings const& slhb)
        : world_(view(world)),
          camera_(camera),
          bounces_(settings.bounces),
          seed_(settings.seed),
          width_(width),
          cone_(slhb.cone),
          interleaving_{std::uint32_t(slhb.interleave)},
          parts_{slhb.exact},
          roulette_(slhb.roulette),
          free_(slhb.look_ups == LookUps::none || slhb.exact.directions),
          meets_light_(!world_.environment_radiance.empty() || !world_.emitter_pdf.empty())
    {
    }

    /// @param samples one per start, overwritten
    /// @param endings empty, or one per start: paths end on the first matt layer and say so here
    /// @param notes   for the cache of the pass, appended
    void trace(Pass const& pass, std::span<PathStart const> starts, std::span<PathSample> samples,
               std::span<SharedVertex> shared_vertices, std::vector<CacheNote>& notes, PathCounts& paths,
               SlhbCounts& counts) const;

private:
    struct State;
    struct Vertex;
    struct Unshadowed;
    struct ShadowRay;
    struct Direct;
    struct Leaving;
    struct Open;

    /// All in one function, so that vectors stay in registers.
    [[gnu::flatten]] bool shade(Pass const& pass, State& s, Vertex& next, Direct& direct, std::span<Open> open,
                                PathCounts& paths) const;
    /// What a light sample brings where nothing is in the way, against the directions of paths.
    vec3 unshadowed(Leaving const& from, LightSample const& light) const;
    void aim_at_light(Pass const& pass, State const& s, Leaving const& from, std::vector<ShadowRay>& rays) const;
    void add_direct(Pass const& pass, State const& s, Leaving const& from, std::vector<Unshadowed>& direct) const;
    void add_sky(Pass const& pass, State& s, Vertex const& last) const;
    void add_emission(State const& s, Vertex const& last, ShadingPoint const& at) const;
    enum class Scattered : std::uint8_t { not_at_all, widely, by_delta_lobe };
    Scattered scatter_by_ray(State& s, Leaving const& from, float u_lobe, bool last) const;
    bool scatter_along_axis(Pass const& pass, State& s, Leaving const& from, Vertex& next) const;
    bool scatter_freely(State& s, Leaving const& from, Vertex& next) const;
    bool starts_indirect(Pass const& pass, State& s) const;
    AxisSample choose_axis(Pass const& pass, State const& s, ShadingPoint const& at) const;
    /// @return look-ups
    std::size_t ask_axes(Pass const& pass, std::span<Vertex> vertices) const;
    void start_paths(Pass const& pass, std::span<PathStart const> starts, std::span<PathSample> samples,
                     std::vector<State>& states, std::vector<Vertex>& vertices) const;
    void prepare_vertices(std::span<Vertex const> vertices, std::vector<State>& states) const;
    void add_lit(Pass const& pass, Direct& direct, SlhbCounts& counts) const;
    void find_hits(Pass const& pass, std::span<Vertex> vertices, std::vector<State>& states,
                   SlhbCounts& counts) const;
    /// Paths whose cell is known end there, but for some that teach it.
    void end_in_cells(Pass const& pass, std::span<State> states, std::vector<Vertex>& vertices,
                      std::size_t& active, std::vector<Open>& open, SlhbCounts& counts) const;
    CacheKeys cache_keys(Pass const& pass, State const& s) const;
    bool ends_shared(State& s, Vertex const& v, SharedVertex& shared) const;
    /// By exact rays in place of shadow maps, see ExactParts.
    void add_exactly(Pass const& pass, std::span<Unshadowed const> direct) const;

    WorldView world_;
    CameraRays camera_;
    int bounces_;
    std::uint64_t seed_;
    int width_;
    float cone_;
    Interleaving interleaving_;
    ExactParts parts_;
    float roulette_;
    bool free_;        ///< paths leave in directions of their own, not along axes
    bool meets_light_; ///< there is light that a path can meet: a sky, or surfaces that emit
};

} // namespace gi
