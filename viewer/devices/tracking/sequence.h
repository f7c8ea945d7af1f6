#pragma once
// Detects loss, reordering and restarts from a sender's counter.

#include "viewer/devices/tracking/tracker_sample.h"

#include <bitset>

namespace viewer {

/// Class of a packet by its number.
enum class Arrival { in_order, late, duplicate, restarted };

class Sequence {
public:
    /// Updates the counts lost, out_of_order, duplicate and restarts. A step of more than kWindow, back or ahead,
    /// counts as a restart of the sender, not as loss.
    Arrival note(std::uint64_t frame, TrackerCounts& counts);

    static constexpr std::uint64_t kWindow = 1024;

private:
    bool started_ = false;
    std::uint64_t first_ = 0, newest_ = 0;
    std::bitset<kWindow> seen_; ///< frame % kWindow, of those in (newest - kWindow, newest]
};

} // namespace viewer
