#pragma once
// Frame sequences with the method slhb. Static hit buffers are built once, and dynamic geometry is added to them;
// schedules that build new axes for every frame draw everything together.

#include "gi/render/frame_renderer.h"

namespace gi {

/// See StartFrames. Throws InputError on settings that do not support dynamic geometry.
std::unique_ptr<FrameRenderer> start_slhb_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report);

/// The same with kernels in a space, see kernel_renderer.h: on the device this is `--device cuda`; on the host it
/// lets tests compare the kernels with the CPU implementation. Also throws InputError on features that kernels
/// lack. Does not render pairs.
std::unique_ptr<FrameRenderer> start_kernel_frames(Space space, MovingWorld const& world, Camera const& camera,
                                                   RenderSettings const& settings, Report& report);

} // namespace gi
