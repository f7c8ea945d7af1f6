#pragma once
// Estimates measurement times for senders without time stamps: arrival times, with the jitter removed by a loop
// that tracks phase and period. The mean delay remains; it cannot be known on the receiving side.

namespace viewer {

class ArrivalClock {
public:
    /// @return the sample's estimated time, s, on the clock of received_s; larger than the previous one.
    /// Restarts after a pause of kPause.
    double note(double received_s);
    double last_s() const { return time_s_; }
    /// Reliability of the order and spacing of samples, 0..1: 1 if arrivals deviate by less than a quarter of a
    /// period, 0 from half a period on, where packets may overtake each other unnoticed.
    double trust() const;

    static constexpr double kPause = 0.25; ///< s

private:
    int count_ = 0;                                                    ///< samples since the (re)start
    double received_s_ = 0, time_s_ = 0, period_s_ = 0, jitter_s_ = 0; ///< jitter: mean absolute error
};

} // namespace viewer
