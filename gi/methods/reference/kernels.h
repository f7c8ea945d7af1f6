#pragma once
// The reference path tracer by kernels in a memory space: on the device this is `--device cuda`; on the host it
// lets tests compare the kernels with the path tracer on Embree, whose estimator and random numbers they share.

#include "gi/render/frame_renderer.h"

namespace gi {

/// See render_reference.
RenderResult render_reference_by_kernels(Space space, World const& world, Camera const& camera,
                                         RenderSettings const& settings, StopRequest const& stop,
                                         RenderProgress const& progress, Report& report);

/// See start_reference_frames.
std::unique_ptr<FrameRenderer> start_reference_kernel_frames(Space space, MovingWorld const& world,
                                                             RenderSettings const& settings, Report& report);

} // namespace gi
