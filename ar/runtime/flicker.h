#pragma once
// Flicker: how much composites change while nothing does. The same camera frame,
// pose and moment again and again, as from a camera on a tripod that looks at a still scene;
// its sensor noise, and what is added of it, stay the same.

#include "ar/pipeline/pipeline.h"

namespace ar {

struct Flicker {
    /// Per block of 8 x 8 pixels that virtual objects cover: standard deviation of its mean radiance over the
    /// frames, in per cent of its mean.
    std::vector<double> blocks_percent;
    /// Standard deviation of 8-bit values over the frames, mean over the pixels that ever changed.
    double bytes = 0;
    int frames = 0;
};

/// @param frame  of the camera  @param pose  its pose
/// @return nothing of a frame in which no virtual object is seen; fewer frames if `stop` was requested
Flicker measure_flicker(Session const& session, Frame const& frame, gi::RigidPose const& pose, double time_s,
                        int frames, gi::StopRequest const& stop, gi::Report& report);

} // namespace ar
