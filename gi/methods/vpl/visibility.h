#pragma once
// The methods vpl_*: indirect light from virtual point lights, all alike but for the visibility between them and
// the surfaces that they light (see visibility_term.h; equations and sources in docs/methods.md).

#include "gi/methods/vpl/visibility_term.h"
#include "gi/render/frame_renderer.h"

namespace gi {

/// Layers: see RenderResult. The same seed gives the same bits whatever the number of threads. All kinds have the
/// same camera paths and virtual lights, pass by pass. Throws InputError on a checkpoint or settings that do not
/// fit.
RenderResult render_with_virtual_lights(VisibilityKind kind, World const& world, Camera const& camera,
                                        RenderSettings const& settings, StopRequest const& stop,
                                        RenderProgress const& progress, Report& report);

/// See StartFrames. Kept are BVHs, hit buffers and points; every frame has virtual lights of its own.
std::unique_ptr<FrameRenderer> start_virtual_light_frames(VisibilityKind kind, MovingWorld const& world,
                                                          RenderSettings const& settings, Report& report);

/// For the registry.
template <VisibilityKind kind>
RenderResult render_visibility(World const& world, Camera const& camera, RenderSettings const& settings,
                               StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_with_virtual_lights(kind, world, camera, settings, stop, progress, report);
}
template <VisibilityKind kind>
std::unique_ptr<FrameRenderer> start_visibility_frames(MovingWorld const& world, Camera const&,
                                                       RenderSettings const& settings, Report& report)
{
    return start_virtual_light_frames(kind, world, settings, report);
}

} // namespace gi
