#include "viewer/protocol/cluster/clock_offset.h"

#include <algorithm>

namespace viewer {

void RoundTripClockOffset::add(Echo const& e, double back_s)
{
    double const ahead = 0.5 * ((e.received_s - e.sent_s) + (e.answered_s - back_s));
    double const delay = (back_s - e.sent_s) - (e.answered_s - e.received_s);
    trips_[added_++ % trips_.size()] = {ahead, std::max(0.0, delay)};
}

std::optional<RoundTripClockOffset::Estimate> RoundTripClockOffset::estimate() const
{
    if (added_ == 0) return {};
    auto const end = trips_.begin() + std::ptrdiff_t(std::min(added_, trips_.size()));
    auto const best =
        std::min_element(trips_.begin(), end, [](Trip const& a, Trip const& b) { return a.delay_s < b.delay_s; });
    return Estimate{best->ahead_s, 0.5 * best->delay_s};
}

} // namespace viewer
