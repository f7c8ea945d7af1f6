#pragma once
// The reference path tracer: slow, obvious, judges the others. See path_tracer.h for the estimator.

#include "gi/image/render_settings.h"
#include "gi/scene/world.h"

namespace gi {

/// Layers: see RenderResult. The same seed gives the same bits whatever the number of threads, the passes it was
/// divided into, or interruptions that were resumed. Throws InputError on a checkpoint that does not fit.
RenderResult render_reference(World const& world, Camera const& camera, RenderSettings const& settings,
                              StopRequest const& stop, RenderProgress const& progress, Report& report);

} // namespace gi
