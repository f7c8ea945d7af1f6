#pragma once
#include "viewer/protocol/cluster/wire.h"

#include <array>
#include <cstddef>
#include <optional>

namespace viewer {

/// How far the clock of another machine is ahead of this one: from messages there and back, of which the fastest
/// says it best (Cristian 1989). With t1 sent, t2 received, t3 answered, t4 back:
///     ahead = ((t2 - t1) + (t3 - t4)) / 2 +- delay / 2,   delay = (t4 - t1) - (t3 - t2)
/// The last 256 count, so that clocks may drift.
class RoundTripClockOffset {
public:
    /// @param back_s  t4
    void add(Echo const& echo, double back_s);
    struct Estimate {
        double ahead_s = 0;
        double error_s = 0; ///< at most, whatever the way there and back took
    };
    /// Nothing before the first message.
    std::optional<Estimate> estimate() const;

private:
    struct Trip {
        double ahead_s, delay_s;
    };
    std::array<Trip, 256> trips_{};
    std::size_t added_ = 0;
};

} // namespace viewer
