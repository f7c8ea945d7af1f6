#pragma once
// Light paths: from the lights over surfaces, as in photon mapping (Jensen 1996). Their vertices are what photon
// methods store and what scatters as virtual point lights (Keller 1997).

#include "gi/light_paths/path_rays.h"
#include "gi/render/path_sample.h"
#include "gi/scene/shading/shading_point.h"

#include <functional>
#include <vector>

namespace gi {

/// A surface point that light has reached.
struct LightVertex {
    vec3 position; ///< m
    vec3 normal;   ///< geometric, unit, on the lit side, the only side from which light leaves
    std::uint32_t triangle;
    float clearance; ///< m, see ShadingPoint
    bool front;      ///< the lit side is the counter-clockwise one
    vec3 power;      ///< power that arrived by this light path, W; includes the correction for shading normals of
                     ///< light travelling from the lights (Veach 1997, eq. 5.19)
    Bsdf bsdf;
    Frame frame;     ///< about the shading normal
    vec3 arrived;    ///< unit, local: direction from which the light came
    bool matt;       ///< purely diffuse: the BSDF is `bsdf.diffuse` / pi
    bool by_delta;   ///< mirrors or glass lie between it and the surface, or light, that it was scattered by last
    int scatterings; ///< non-delta, before it: 0 = light that comes from its source, or by mirrors and glass alone
    /// Area over which the path's light is spread there, m^2: the reciprocal of the path density, the number of
    /// such paths per m^2 (McGuire and Luebke 2009; Herzog et al. 2007). Mirrors and glass count as flat.
    float footprint;
    std::uint32_t path; ///< number of its path, or index of its start
};

/// Where a point of a surface lies relative to a fine grid; `still`: of a triangle that does not move.
enum class GridSide : std::uint8_t { outside, inside_moving, inside_still };

struct LightPaths {
    std::uint32_t count = 256;           ///< >= 1
    std::uint32_t first = 0, last = ~0u; ///< those of them to trace: first to last - 1
    int bounces = 1;                     ///< indirect bounces of the picture; a virtual light is the first of them
    std::uint64_t seed = 0;
    std::uint32_t pass = 0;
    /// Half of the sky's and the parallel lights' paths go through the sphere around this box, the others past it;
    /// empty = all go through the whole scene.
    Bounds focus{};
    bool delta_only = false; ///< paths end where they would be scattered other than by mirrors and glass
    /// If set, paths that come from outside of a fine grid or from afar, not by mirrors or glass, end at its still
    /// surfaces without a trace, as other paths start there (LightStart).
    std::function<GridSide(vec3 position, std::uint32_t triangle)> grid_side{};
    BuildStop const* stop = nullptr; ///< null = never; else trace_light_paths() throws Interrupted
};

/// Returns virtual lights in the order of the paths, for any number of threads. Empty if there are no lights or
/// bounces == 0.
std::vector<LightVertex> trace_light_paths(WorldView const& world, Bounds const& bounds, PathRays const& rays,
                                           LightPaths const& settings, PathCounts& counts);

/// Light that has reached a surface: the start of a path from there.
struct LightStart {
    Hit hit;
    vec3 direction;       ///< unit, in which the light travels
    vec3 power;           ///< W
    std::uint32_t number; ///< of its random numbers
    int scatterings;      ///< of the light before, at least
};
/// As trace_light_paths(), for paths that begin so.
std::vector<LightVertex> trace_from_surfaces(WorldView const& world, PathRays const& rays,
                                             std::span<LightStart const> starts, LightPaths const& settings,
                                             PathCounts& counts);

} // namespace gi
