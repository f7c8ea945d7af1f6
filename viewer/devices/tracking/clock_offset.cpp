#include "viewer/devices/tracking/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viewer {

ClockNote OneWayClockOffset::note(double measured_s, double received_s)
{
    double const delay = received_s - measured_s;
    bool const fits = !started_ || (delay > offset_s_ - kEarliest && delay < offset_s_ + kLatest);
    bool const confirmed = !fits && doubt_s_ && std::abs(delay - *doubt_s_) < kEarliest;
    doubt_s_.reset();
    if (!fits && !confirmed) {
        doubt_s_ = delay;
        ++doubtful_;
        return ClockNote::doubtful;
    }
    if (!started_ || confirmed) {
        started_ = true;
        restarts_ += confirmed;
        least_.fill(std::numeric_limits<double>::infinity());
        piece_end_s_ = received_s + 1;
    }
    if (received_s >= piece_end_s_) {
        // Advance by one piece after any pause, so that a pause does not discard the estimate.
        piece_ = (piece_ + 1) % kWindow;
        least_[piece_] = std::numeric_limits<double>::infinity();
        piece_end_s_ = received_s + 1;
    }
    least_[piece_] = std::min(least_[piece_], delay);
    offset_s_ = *std::min_element(least_.begin(), least_.end());
    return confirmed ? ClockNote::was_set : ClockNote::fits;
}

} // namespace viewer
