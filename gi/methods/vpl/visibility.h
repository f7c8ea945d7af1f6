#pragma once
// The methods vpl_*: indirect light from virtual point lights. They differ only in the visibility
// between virtual lights and the surfaces that these illuminate (see visibility_term.h;
// equations and sources in docs/methods/vpl.md).

#include "gi/methods/vpl/visibility_term.h"
#include "gi/render/frame_renderer.h"
#include "gi/render/render_option.h"

namespace gi {

/// Layers: see RenderResult. The same seed gives the same bits for any number of threads. All kinds use the same
/// camera paths and virtual lights in each pass. Throws InputError if the checkpoint or the settings do not fit.
RenderResult render_with_virtual_lights(VisibilityKind kind, World const& world, Camera const& camera,
                                        RenderSettings const& settings, StopRequest const& stop,
                                        RenderProgress const& progress, Report& report);

/// See StartFrames. BVHs, hit buffers and points are kept; every frame has its own virtual lights.
std::unique_ptr<FrameRenderer> start_virtual_light_frames(VisibilityKind kind, MovingWorld const& world,
                                                          RenderSettings const& settings, Report& report);

/// Options of the methods vpl_*.
RenderOptionTable const& virtual_light_options();

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
