#pragma once
// The method slhb: global illumination through spherical layered hit buffers (Yu 2012, ch. 5). Paths find surfaces by
// look-ups along axes that all paths of a pass share, and test light samples by shadow maps; on the CPU (in the path
// tracer of gi/methods/paths) and as CUDA kernels. And the two methods that replace one of both by exact rays.

#include "gi/methods/paths/paths.h"

namespace gi {

/// See Method. Throws InputError on incompatible settings.
RenderResult render_slhb(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_slhb_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report);

RenderSettings slhb_for_display(RenderSettings settings);
ExposurePlan slhb_exposure(World const& world, RenderSettings const& asked, Camera const& camera,
                           Triangles triangles);
/// Of any method that looks up. @param by  what its paths do
ExposurePlan look_up_exposure(std::string_view method, PathAlgorithm by, World const& world,
                              RenderSettings const& asked, Triangles triangles);
bool slhb_updates_axes(RenderSettings const& settings);

/// The methods that find surfaces in one way and shadows in the other. See Method.
template <SurfacesBy surfaces>
struct Mixed {
    static constexpr bool kLooksUp = surfaces == SurfacesBy::look_ups;
    static constexpr char const* kName = kLooksUp ? "slhb_shadow_rays" : "paths_shadow_maps";
    static constexpr PathAlgorithm kBy{surfaces, kLooksUp ? ShadowsBy::rays : ShadowsBy::maps, !kLooksUp};

    static RenderResult render(World const& world, Camera const& camera, RenderSettings const& settings,
                               StopRequest const& stop, RenderProgress const& progress, Report& report)
    {
        return render_by(kName, world, camera, with(kBy, settings), stop, progress, report);
    }
    static std::unique_ptr<FrameRenderer> frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report)
    {
        return start_frames_by(world, camera, with(kBy, settings), report);
    }
    static ExposurePlan exposure(World const& world, RenderSettings const& asked, Camera const&,
                                 Triangles triangles)
    {
        return look_up_exposure(kName, kBy, world, asked, triangles);
    }
};
using SlhbShadowRays = Mixed<SurfacesBy::look_ups>;
using PathsShadowMaps = Mixed<SurfacesBy::rays>;

} // namespace gi
