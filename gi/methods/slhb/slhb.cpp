#include "gi/methods/slhb/slhb.h"

#include "gi/kernel/device.h"
#include "gi/methods/paths/frames_of.h"
#include "gi/methods/paths/paths.h"
#include "gi/methods/slhb/kernels/kernel_render.h"
#include "gi/methods/slhb/kernels/kernel_renderer.h"

namespace gi {
namespace {

constexpr PathAlgorithm kSlhbShadowRays{SurfacesBy::look_ups, ShadowsBy::rays, false},
    kPathsShadowMaps{SurfacesBy::rays, ShadowsBy::maps};

ExposurePlan exposure_by(std::string_view method, PathAlgorithm by, World const& world, RenderSettings const& asked,
                         Triangles triangles)
{
    RenderSettings s = with(by, asked);
    SlhbSettings& buffers = s.of<SlhbSettings>();
    // Appending moving triangles to all stored axes again for every path is more work than new axes.
    bool const any_axes =
        buffers.schedule == Schedule::automatic && buffers.directions.empty() && buffers.fresh_axes == 0;
    if (triangles == Triangles::moving && any_axes) buffers.schedule = Schedule::streamed;
    if (s.budget_s > 0) s = choose_settings(s, world, make_soup(world));
    return {method, s};
}

} // namespace

RenderResult render_slhb(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    RenderSettings const s = with(kSlhb, settings);
    if (s.space == Space::host) return render_by("slhb", world, camera, s, stop, progress, report);
    check_device(Space::device);
    return render_by_kernels(Space::device, world, camera, s, stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_slhb_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report)
{
    RenderSettings const s = with(kSlhb, settings);
    if (s.space == Space::host) return start_frames_by(world, camera, s, report);
    check_device(Space::device);
    return start_kernel_frames(Space::device, world, camera, s, report);
}

RenderSettings slhb_for_display(RenderSettings settings)
{
    settings = paths_for_display(std::move(settings));
    // The same axes for all frames: fresh axes in every frame would flicker.
    Schedule& schedule = settings.of<SlhbSettings>().schedule;
    if (schedule == Schedule::automatic) schedule = Schedule::stored;
    return settings;
}

ExposurePlan slhb_exposure(World const& world, RenderSettings const& asked, Camera const&, Triangles triangles)
{
    ExposurePlan plan = exposure_by("slhb", kSlhb, world, asked, triangles);
    if (asked.space == Space::device) KernelRenderer<Space::device>::limit(plan.settings);
    return plan;
}

ExposurePlan slhb_shadow_rays_exposure(World const& world, RenderSettings const& asked, Camera const&,
                                       Triangles triangles)
{
    return exposure_by("slhb_shadow_rays", kSlhbShadowRays, world, asked, triangles);
}

ExposurePlan paths_shadow_maps_exposure(World const& world, RenderSettings const& asked, Camera const&,
                                        Triangles triangles)
{
    return exposure_by("paths_shadow_maps", kPathsShadowMaps, world, asked, triangles);
}

bool slhb_updates_axes(RenderSettings const& settings)
{
    return settings.of<SlhbSettings>().schedule == Schedule::automatic;
}

RenderResult render_slhb_shadow_rays(World const& world, Camera const& camera, RenderSettings const& settings,
                                     StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_by("slhb_shadow_rays", world, camera, with(kSlhbShadowRays, settings), stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_slhb_shadow_rays_frames(MovingWorld const& world, Camera const& camera,
                                                             RenderSettings const& settings, Report& report)
{
    return start_frames_by(world, camera, with(kSlhbShadowRays, settings), report);
}

RenderResult render_paths_shadow_maps(World const& world, Camera const& camera, RenderSettings const& settings,
                                      StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_by("paths_shadow_maps", world, camera, with(kPathsShadowMaps, settings), stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_paths_shadow_maps_frames(MovingWorld const& world, Camera const& camera,
                                                              RenderSettings const& settings, Report& report)
{
    return start_frames_by(world, camera, with(kPathsShadowMaps, settings), report);
}

std::unique_ptr<FrameRenderer> start_kernel_frames(Space space, MovingWorld const& world, Camera const& camera,
                                                   RenderSettings const& settings, Report& report)
{
    RenderSettings const s = with(kSlhb, settings);
    if (space == Space::host)
        return std::make_unique<PathsFrames<KernelRenderer<Space::host>>>(world, camera, s, report);
    return std::make_unique<PathsFrames<KernelRenderer<Space::device>>>(world, camera, s, report);
}

} // namespace gi
