#pragma once
// Light paths: from the lights over surfaces, as in photon mapping (Jensen 1996). Their vertices are what photon
// methods store and what scatters as virtual point lights (Keller 1997).

#include "gi/light_paths/light_path_step.h"
#include "gi/light_paths/path_rays.h"
#include "gi/render/path_sample.h"
#include "gi/scene/shading/shading_point.h"

#include <functional>
#include <vector>

namespace gi {

/// Where a point of a surface lies relative to a fine grid, and whether its triangle moves.
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

/// Returns virtual lights in the order of the paths, for any number of threads.
/// Empty if there are no lights or bounces == 0.
std::vector<LightVertex> trace_light_paths(WorldView const& world, Bounds const& bounds, PathRays const& rays,
                                           LightPaths const& settings, PathCounts& counts);

/// As trace_light_paths(), for paths already begun; those without power have ended.
std::vector<LightVertex> trace_onwards(WorldView const& world, PathRays const& rays,
                                       std::span<LightPath const> paths, LightPaths const& settings,
                                       PathCounts& counts);

/// Light that has reached a surface: the start of a path from there.
struct LightStart {
    Hit hit;
    vec3 direction;       ///< unit, in which the light travels
    vec3 power;           ///< W
    std::uint32_t number; ///< of its random numbers
    int scatterings;      ///< of the light before, at least
};
/// As trace_light_paths(), for paths that begin on surfaces.
std::vector<LightVertex> trace_from_surfaces(WorldView const& world, PathRays const& rays,
                                             std::span<LightStart const> starts, LightPaths const& settings,
                                             PathCounts& counts);

} // namespace gi
