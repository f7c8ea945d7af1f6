#pragma once
// Frame sequences of slhb and paths by kernels in a space, see kernel_renderer.h: on the device this is
// `--device cuda`; on the host it lets tests compare the kernels with the forms of the CPU.

#include "gi/render/frame_renderer.h"

namespace gi {

/// slhb. Throws InputError on features that kernels lack.
std::unique_ptr<FrameRenderer> start_kernel_frames(Space space, MovingWorld const& world, Camera const& camera,
                                                   RenderSettings const& settings, Report& report);
/// paths. The same.
std::unique_ptr<FrameRenderer> start_path_kernel_frames(Space space, MovingWorld const& world,
                                                        Camera const& camera, RenderSettings const& settings,
                                                        Report& report);

} // namespace gi
