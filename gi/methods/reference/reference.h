#pragma once
// The reference path tracer: slow, obvious, judges the others. See path_tracer.h for the estimator.

#include "gi/render/frame_renderer.h"

namespace gi {

/// Layers: see RenderResult. The same seed gives the same bits whatever the number of threads, the passes it was
/// divided into, or interruptions that were resumed. Throws InputError on a checkpoint that does not fit.
RenderResult render_reference(World const& world, Camera const& camera, RenderSettings const& settings,
                              StopRequest const& stop, RenderProgress const& progress, Report& report);

/// See StartFrames. Every frame has paths of its own and the layer "motion"; the BVH of what moves is refitted.
std::unique_ptr<FrameRenderer> start_reference_frames(MovingWorld const& world, Camera const& camera,
                                                      RenderSettings const& settings, Report& report);

} // namespace gi
