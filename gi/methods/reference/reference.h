#pragma once
// The reference path tracer: slow and simple, used to validate the other methods.
// See path_tracer.h for the estimator.

#include "gi/render/frame_renderer.h"

namespace gi {

/// Layers: see RenderResult. The same seed gives the same bits for any number of threads, any split into passes,
/// and after resumed interruptions. Throws InputError if the checkpoint does not fit.
RenderResult render_reference(World const& world, Camera const& camera, RenderSettings const& settings,
                              StopRequest const& stop, RenderProgress const& progress, Report& report);

/// See StartFrames. Every frame has its own paths and the layer "motion"; the BVH of dynamic geometry is refitted.
std::unique_ptr<FrameRenderer> start_reference_frames(MovingWorld const& world, Camera const& camera,
                                                      RenderSettings const& settings, Report& report);

} // namespace gi
