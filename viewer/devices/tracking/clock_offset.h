#pragma once
// The sender's clock against ours, from packets whose delay varies: a minimum filter. Of those of the last seconds
// the one that travelled fastest decides; what even that one took cannot be known from one side and is a setting
// (PredictionSettings::latency_s).

#include <array>
#include <cstdint>
#include <optional>

namespace viewer {

/// What a time stamp says of the sender's clock.
enum class ClockNote {
    fits,
    doubtful, ///< too far from what is known; not used unless the next one says the same
    was_set   ///< two did: what was known before is forgotten
};

class OneWayClockOffset {
public:
    /// Both in s.
    ClockNote note(double measured_s, double received_s);
    /// Least received - measured of the last kWindow seconds, s. 0 before the first sample.
    double offset_s() const { return offset_s_; }
    double to_local(double measured_s) const { return measured_s + offset_s_; }
    double to_sender(double local_s) const { return local_s - offset_s_; }
    std::uint64_t restarts() const { return restarts_; }
    std::uint64_t doubtful() const { return doubtful_; }

    static constexpr double kLatest = 2;      ///< s behind the fastest: later ones are doubtful
    static constexpr double kEarliest = 0.1;  ///< s ahead of the fastest: earlier ones are doubtful
    static constexpr std::size_t kWindow = 8; ///< s, in pieces of 1 s: clocks that drift are followed

private:
    bool started_ = false;
    double offset_s_ = 0;
    std::array<double, kWindow> least_{};
    std::size_t piece_ = 0;
    double piece_end_s_ = 0;        ///< received
    std::optional<double> doubt_s_; ///< delay of the sample before, if it was doubtful
    std::uint64_t restarts_ = 0, doubtful_ = 0;
};

} // namespace viewer
