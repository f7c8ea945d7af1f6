#pragma once
// Frames by the method slhb. Static hit buffers are built once; what moves is appended to them, or drawn with the
// rest where the schedule builds fresh axes for every frame anyway.

#include "gi/render/frame_renderer.h"

namespace gi {

/// See StartFrames. Throws InputError on settings that cannot work with what moves.
std::unique_ptr<FrameRenderer> start_slhb_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report);

/// The same by kernels in a space, see kernel_renderer.h: on the device this is `--device cuda`; on the host it is
/// there so that tests can hold it to the CPU's own form. Throws InputError on what kernels cannot do, too. It
/// makes no pairs.
std::unique_ptr<FrameRenderer> start_kernel_frames(Space space, MovingWorld const& world, Camera const& camera,
                                                   RenderSettings const& settings, Report& report);

} // namespace gi
