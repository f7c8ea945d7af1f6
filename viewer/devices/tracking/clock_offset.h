#pragma once
// Estimates the offset between the sender's clock and ours from packets with varying delay, by a minimum filter:
// the fastest packet of the last seconds counts. Its own delay cannot be known from one side and is
// a setting (PredictionSettings::latency_s).

#include <array>
#include <cstdint>
#include <optional>

namespace viewer {

/// Assessment of a time stamp.
enum class ClockNote {
    fits,
    doubtful, ///< too far from the current estimate; used only if the next one agrees
    was_set   ///< two in succession agreed: the clock was set, and the old estimate is discarded
};

class OneWayClockOffset {
public:
    /// Both in s.
    ClockNote note(double measured_s, double received_s);
    /// Minimum of received - measured over the last kWindow seconds, s. 0 before the first sample.
    double offset_s() const { return offset_s_; }
    double to_local(double measured_s) const { return measured_s + offset_s_; }
    double to_sender(double local_s) const { return local_s - offset_s_; }
    std::uint64_t restarts() const { return restarts_; }
    std::uint64_t doubtful() const { return doubtful_; }

    static constexpr double kLatest = 2;      ///< s behind the fastest: later ones are doubtful
    static constexpr double kEarliest = 0.1;  ///< s ahead of the fastest: earlier ones are doubtful
    static constexpr std::size_t kWindow = 8; ///< s, in pieces of 1 s, so that clock drift is tracked

private:
    bool started_ = false;
    double offset_s_ = 0;
    std::array<double, kWindow> least_{};
    std::size_t piece_ = 0;
    double piece_end_s_ = 0;        ///< by received time
    std::optional<double> doubt_s_; ///< delay of the previous sample, if it was doubtful
    std::uint64_t restarts_ = 0, doubtful_ = 0;
};

} // namespace viewer
