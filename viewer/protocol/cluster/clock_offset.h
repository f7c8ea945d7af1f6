#pragma once
#include "viewer/protocol/cluster/wire.h"

#include <array>
#include <cstddef>
#include <optional>

namespace viewer {

/// Estimates how far another machine's clock is ahead of this one from round trips, of which the fastest is the
/// most accurate (Cristian 1989). With t1 sent, t2 received, t3 answered, t4 back:
///     ahead = ((t2 - t1) + (t3 - t4)) / 2 +- delay / 2,   delay = (t4 - t1) - (t3 - t2)
/// Only the last 256 round trips count, because clocks drift.
class RoundTripClockOffset {
public:
    /// @param back_s  t4
    void add(Echo const& echo, double back_s);
    struct Estimate {
        double ahead_s = 0;
        double error_s = 0; ///< upper bound, for any split of the delay between the two ways
    };
    /// None before the first round trip.
    std::optional<Estimate> estimate() const;

private:
    struct Trip {
        double ahead_s, delay_s;
    };
    std::array<Trip, 256> trips_{};
    std::size_t added_ = 0;
};

} // namespace viewer
