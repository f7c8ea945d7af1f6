#pragma once
// Checks what must hold for the samples of every parser of tracker packets.

#include "gi/core/pose.h"
#include "viewer/devices/tracking/tracker_sample.h"

namespace viewer {

inline void expect_samples(TrackerPacket const& packet)
{
    for (TrackerSample const& s : packet.samples) {
        bool const good = is_finite(s.pose) && std::abs(glm::length(s.pose.rotation) - 1) < 1e-9 &&
                          !s.body.empty() && s.quality >= 0 && s.quality <= 1 &&
                          std::isfinite(s.measured_s.value_or(0));
        if (!good) __builtin_trap();
    }
}

} // namespace viewer
