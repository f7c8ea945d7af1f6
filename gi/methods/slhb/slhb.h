#pragma once
// The method slhb: global illumination through spherical layered hit buffers (Yu 2012, ch. 5). Paths find surfaces by
// look-ups along axes that all paths of a pass share, and test light samples by shadow maps; on the CPU (in the path
// tracer of gi/methods/paths) and as CUDA kernels. And the two methods that replace one of both by exact rays.

#include "gi/render/method.h"
#include "gi/methods/paths/algorithm.h"

namespace gi {

/// See Method. Throws InputError on incompatible settings.
RenderResult render_slhb(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_slhb_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report);

RenderSettings slhb_for_display(RenderSettings settings);
ExposurePlan slhb_exposure(World const& world, RenderSettings const& asked, Camera const& camera,
                           Triangles triangles);
ExposurePlan slhb_shadow_rays_exposure(World const& world, RenderSettings const& asked, Camera const& camera,
                                       Triangles triangles);
ExposurePlan paths_shadow_maps_exposure(World const& world, RenderSettings const& asked, Camera const& camera,
                                        Triangles triangles);
bool slhb_updates_axes(RenderSettings const& settings);

/// Look-ups for surfaces, exact rays for shadows.
RenderResult render_slhb_shadow_rays(World const& world, Camera const& camera, RenderSettings const& settings,
                                     StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_slhb_shadow_rays_frames(MovingWorld const& world, Camera const& camera,
                                                             RenderSettings const& settings, Report& report);

/// Exact rays for surfaces, shadow maps.
RenderResult render_paths_shadow_maps(World const& world, Camera const& camera, RenderSettings const& settings,
                                      StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_paths_shadow_maps_frames(MovingWorld const& world, Camera const& camera,
                                                              RenderSettings const& settings, Report& report);

/// The frames of slhb by kernels in a space, see kernel_renderer.h: on the device this is `--device cuda`; on the host
/// it lets tests compare the kernels with the CPU implementation. Throws InputError on features that kernels lack.
std::unique_ptr<FrameRenderer> start_kernel_frames(Space space, MovingWorld const& world, Camera const& camera,
                                                   RenderSettings const& settings, Report& report);

} // namespace gi
