#pragma once
// How paths from the camera find surfaces and test light samples. Each combination is a method of its own: paths, slhb,
// paths_shadow_maps, slhb_shadow_rays, paths_layered_lens; of those on the screen, only screen_lhb.

#include "gi/render/render_settings.h"

namespace gi {

/// What finds the next surface of a path that leaves by a broad lobe;
/// mirrors, glass and narrow lobes always take exact rays, as may what is doubtful.
enum class SurfacesBy : std::uint8_t {
    rays,     ///< each path in its own direction
    look_ups, ///< in hit buffers, along axes that all paths of a pass share
    screen    ///< each path in its own direction, among what the view shows (screen_layers.h)
};

/// What tests whether a light sample is visible.
enum class ShadowsBy : std::uint8_t {
    rays, ///< each path to its own light samples
    maps  ///< shadow maps of a few light samples, shared by all paths of a pass
};

/// Held by RenderSettings beside the options; the method sets it.
struct PathAlgorithm {
    SurfacesBy surfaces = SurfacesBy::rays;
    ShadowsBy shadows = ShadowsBy::rays;
    bool caches = true; ///< RadianceCaching::automatic may choose a cache
    bool layered_lens = false; ///< a view with a lens is shaded once and gathered from (layered_lens.h)
    bool nested = true; ///< look-ups and maps have windows around the cameras (windows.h)

    bool only_looks_up() const { return surfaces == SurfacesBy::look_ups && shadows == ShadowsBy::maps; }
};

/// Cells of a cache are no part of the method: paths end in them on request only.
inline constexpr PathAlgorithm kSlhb{SurfacesBy::look_ups, ShadowsBy::maps, false};

inline constexpr PathAlgorithm kPathsLayeredLens{.layered_lens = true};
inline constexpr PathAlgorithm kScreenLhb{SurfacesBy::screen, ShadowsBy::rays, false};

/// How first surfaces are found:
enum class FirstSurfaces : std::uint8_t {
    by_raster, ///< by a G-buffer per pass; needed for motion vectors and partner views
    by_rays,   ///< by an exact ray per path, each through its own subpixel position
};

/// Seconds of the budget that passed before the call, as of choosing the method.
struct SpentBeforehand {
    double seconds = 0;
};

inline RenderSettings with(PathAlgorithm algorithm, RenderSettings settings)
{
    settings.of<PathAlgorithm>() = algorithm;
    return settings;
}

} // namespace gi
