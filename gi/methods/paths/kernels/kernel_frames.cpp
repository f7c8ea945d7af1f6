#include "gi/methods/paths/kernels/kernel_frames.h"

#include "gi/methods/paths/frames_of.h"
#include "gi/methods/paths/kernels/kernel_renderer.h"

namespace gi {
namespace {

std::unique_ptr<FrameRenderer> kernel_frames_in(Space space, MovingWorld const& world, Camera const& camera,
                                                RenderSettings const& settings, Report& report)
{
    if (space == Space::host)
        return std::make_unique<PathsFrames<KernelRenderer<Space::host>>>(world, camera, settings, report);
    return std::make_unique<PathsFrames<KernelRenderer<Space::device>>>(world, camera, settings, report);
}

} // namespace

std::unique_ptr<FrameRenderer> start_kernel_frames(Space space, MovingWorld const& world, Camera const& camera,
                                                   RenderSettings const& settings, Report& report)
{
    return kernel_frames_in(space, world, camera, with(kSlhb, settings), report);
}

std::unique_ptr<FrameRenderer> start_path_kernel_frames(Space space, MovingWorld const& world,
                                                        Camera const& camera, RenderSettings const& settings,
                                                        Report& report)
{
    return kernel_frames_in(space, world, camera, with(PathAlgorithm{}, settings), report);
}

} // namespace gi
