#include "gi/methods/slhb/slhb.h"

#include "gi/kernel/device.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/methods/paths/choose.h"
#include "gi/methods/paths/kernels/kernel_frames.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/paths/kernels/kernel_renderer.h"

namespace gi {

RenderResult render_slhb(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    RenderSettings const s = with(kSlhb, settings);
    if (s.space == Space::host) return render_by("slhb", world, camera, s, stop, progress, report);
    check_device(Space::device);
    lose_lamp_caustics(world, report);
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
    ExposurePlan plan = look_up_exposure("slhb", kSlhb, world, asked, triangles);
    if (asked.space == Space::device) KernelRenderer<Space::device>::limit(plan.settings);
    return plan;
}

ExposurePlan look_up_exposure(std::string_view method, PathAlgorithm by, World const& world,
                              RenderSettings const& asked, Triangles triangles)
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

bool slhb_updates_axes(RenderSettings const& settings)
{
    return settings.of<SlhbSettings>().schedule == Schedule::automatic;
}

} // namespace gi
