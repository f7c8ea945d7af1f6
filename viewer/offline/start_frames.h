#pragma once
#include "gi/core/step.h"
#include "gi/methods/registry.h"

namespace viewer {

/// Method::frames, whose building throws Interrupted after a stop request.
inline std::unique_ptr<gi::FrameRenderer> start_frames(gi::Method const& method, gi::MovingWorld const& world,
                                                       gi::Camera const& camera,
                                                       gi::RenderSettings const& settings, gi::Report& report,
                                                       gi::StopRequest const& stop)
{
    gi::StepListener const building(
        [&](gi::Step const&) {
            if (stop.requested()) throw gi::Interrupted();
        },
        &stop);
    return method.frames(world, camera, settings, report);
}

} // namespace viewer
