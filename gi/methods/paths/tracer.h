#pragma once
// Paths through layered hit buffers. First surfaces come from a G-buffer, direct light from shadow maps; a
// diffuse or broad lobe continues along one of the axes of the pass (hemisphere formulation, Yu 2012, eq. 5.7), a
// mirror, glass or narrow lobe with an exact ray. Paths of a block advance together, one surface at a time: all
// shading, then all look-ups.
//
// Estimators. Axis k is drawn with probability p_k proportional to solid angle times cosine;
// the factor of a path is f cos w_k / p_k, times the balance heuristic against narrow lobes, if any
// (one-sample model, Veach 1997, sec. 9.2.4). Lights are found only by light sampling, except on exact rays;
// the sky is found by both, with the power heuristic.

#include "gi/core/rqmc.h"
#include "gi/hit_buffers/axis_step.h"
#include "gi/hit_buffers/settings.h"
#include "gi/hit_buffers/shadow_maps/light_points.h"
#include "gi/light_paths/photon_map.h"
#include "gi/methods/paths/algorithm.h"
#include "gi/methods/paths/light_pool.h"
#include "gi/methods/paths/radiance_cache.h"
#include "gi/methods/paths/screen_layers.h"
#include "gi/methods/paths/settings.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/interleaving.h"
#include "gi/render/path_sample.h"
#include "gi/scene/model/used_materials.h"

#include <span>

namespace gi {

/// Work done, for --stats.
struct PathsWork {
    std::uint64_t queries = 0, exact_rays = 0, shadow_lookups = 0, shadow_rays = 0, cache_reads = 0;
    std::uint64_t doubtful_queries = 0, doubtful_shadows = 0; ///< of these look-ups, decided by exact rays
    /// Summed over threads: first surfaces with direct light; all later vertices.
    double direct_s = 0, indirect_s = 0;
};

/// Start of a path: a surface that the camera sees, or a layer hit by several paths.
struct PathStart {
    std::uint32_t stream;   ///< of random numbers: index of the pixel
    std::uint32_t triangle; ///< kNoPrimitive = none
    Ray ray;                ///< the arriving ray; for a layer, its origin is the point on the triangle
    bool on_layer = false;  ///< starts on a layer, after the first scattering
};

/// End of a path on a diffuse surface, where the outgoing light is the same for all paths
/// that hit the same side of a layer.
struct SharedVertex {
    std::uint32_t triangle = kNoLayerHit; ///< kNoLayerHit = no shared vertex
    std::uint32_t layer = kNoLayerHit;    ///< index in the pool
    bool up = false;                      ///< direction of the walk that hit the layer
    vec3 position{0};
    vec3 arrival{0}; ///< direction of the path
    vec3 throughput{0};
};

/// Sky radiance for a path along an axis that hits nothing.
struct SkyAlong {
    vec3 radiance;
    float pdf; ///< of light sampling, 1/sr
};
/// For all axes: first against the axis, then along it.
std::vector<SkyAlong> sky_along(AxisSet const& axes, World const& world);

class PathsTracer {
public:
    /// Parameters that are constant during a pass. `exact` may be null if needs_exact_rays is false.
    struct Pass {
        AxisSet const& axes;
        LightPoints const& light_points;
        ExactVisibility const* exact;
        PassStop& stop;            ///< once given up, samples are not valid
        std::uint32_t index;       ///< index of each pixel's path
        std::uint32_t gather_axis; ///< axis used by every first bounce; kNoPrimitive = random
        /// Index of the first watched triangle: PathSample::near_moving is set if a triangle from here on may
        /// have affected the path. Number of triangles or more = off.
        std::uint32_t first_watched = kNoPrimitive;
        RayWorld exact_world = RayWorld::all;
        std::span<SkyAlong const> sky = {}; ///< per axis direction; may be empty
        /// Light samples tested by exact rays; null = `light_points` are used.
        LightPool const* lights = nullptr;
        bool smooth = false;                ///< the world contains a mirror or glass
        bool look_ups = true;               ///< else exact rays, or `screen`
        bool exact_shadows = false;         ///< in place of shadow maps
        ScreenLayers const* screen = nullptr; ///< of the view; null = surfaces are found elsewhere
        bool confirms = false;              ///< exact rays decide where look-ups and shadow maps are doubtful
        RadianceCache* cache = nullptr;     ///< paths may end in its cells; null = no cache
        bool spread = false;                ///< pixels without indirect light will get it from neighbours
        bool no_punctual = false;           ///< see FrameRenderer::leave_out_punctual
        PhotonMap const* caustics = nullptr; ///< of lamps; null = none
    };

    /// @param width  of the picture, pixels
    /// @param settings  chosen ones
    PathsTracer(World const& world, CameraRays const& camera, int width, RenderSettings const& settings)
        : world_(view(world)),
          camera_(camera),
          bounces_(settings.bounces),
          seed_(settings.seed),
          width_(width),
          cone_(settings.of<SlhbSettings>().cone),
          interleaving_{std::uint32_t(settings.of<PathsSettings>().interleave)},
          parts_{settings.of<SlhbSettings>().exact},
          roulette_(settings.of<PathsSettings>().roulette),
          free_(settings.of<PathAlgorithm>().surfaces != SurfacesBy::look_ups || parts_.directions),
          meets_light_(!world_.environment_radiance.empty() || !world_.emitter_pdf.empty()),
          panes_(has_panes(world))
    {
    }

    /// @param samples  one per start, overwritten
    /// @param shared_vertices  empty, or one per start: paths end on the first diffuse layer, which is stored here
    /// @param notes   notes for the radiance cache are appended here
    void trace(Pass const& pass, std::span<PathStart const> starts, std::span<PathSample> samples,
               std::span<SharedVertex> shared_vertices, std::vector<CacheNote>& notes, PathCounts& paths,
               PathsWork& counts) const;

private:
    struct State;
    struct Vertex;
    struct Unshadowed;
    struct ShadowRay;
    struct Direct;
    struct Leaving;
    struct Open;

    /// Flattened into one function, so that vectors stay in registers.
    [[gnu::flatten]] bool shade(Pass const& pass, State& s, Vertex& next, Direct& direct, std::span<Open> open,
                                PathCounts& paths) const;
    /// Unoccluded contribution of a light sample, weighted against the sampling of path directions.
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
    void ask_axes(Pass const& pass, std::span<Vertex> vertices, PathsWork& counts) const;
    void start_paths(Pass const& pass, std::span<PathStart const> starts, std::span<PathSample> samples,
                     std::vector<State>& states, std::vector<Vertex>& vertices) const;
    void prepare_vertices(std::span<Vertex const> vertices, std::vector<State>& states) const;
    void add_lit(Pass const& pass, Direct& direct, PathsWork& counts) const;
    void add_by_maps(Pass const& pass, std::vector<Unshadowed>& direct, PathsWork& counts) const;
    void find_hits(Pass const& pass, std::span<Vertex> vertices, std::vector<State>& states,
                   PathsWork& counts) const;
    bool meets_inside(LayerHit const& hit, vec3 direction) const;
    /// Ends paths whose cell is known, except some that continue to teach it.
    void end_in_cells(Pass const& pass, std::span<State> states, std::vector<Vertex>& vertices,
                      std::size_t& active, std::vector<Open>& open, PathsWork& counts) const;
    CacheKeys cache_keys(Pass const& pass, State const& s) const;
    bool ends_shared(State& s, Vertex const& v, SharedVertex& shared) const;
    /// Uses exact rays instead of shadow maps, see ExactParts.
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
    bool free_;        ///< each path samples its own directions instead of axes
    bool meets_light_; ///< paths can hit light: a sky or emissive surfaces
    bool panes_;
};

} // namespace gi
