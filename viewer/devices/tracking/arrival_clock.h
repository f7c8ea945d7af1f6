#pragma once
// When samples were measured, for senders that do not say it: their arrivals, with the jitter taken out by a loop
// that follows phase and period. What remains is the mean delay, which nobody here can know.

namespace viewer {

class ArrivalClock {
public:
    /// @return a time for the sample, s, on the clock of received_s; larger than the one before. After a pause of
    ///   kPause it begins anew.
    double note(double received_s);
    double last_s() const { return time_s_; }
    /// How far the order and the distances of samples can be believed, 0..1: 1 where arrivals are off by less than
    /// a quarter of a period, 0 from half a period on, when packets overtake each other unseen.
    double trust() const;

    static constexpr double kPause = 0.25; ///< s

private:
    int count_ = 0;                                                    ///< samples since it began
    double received_s_ = 0, time_s_ = 0, period_s_ = 0, jitter_s_ = 0; ///< jitter: mean size of errors
};

} // namespace viewer
