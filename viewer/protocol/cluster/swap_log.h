#pragma once
// How far apart the ranks of a cluster swap their buffers.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace viewer {

/// From the first rank that swaps to the last, s.
struct SwapSkew {
    std::uint64_t frames = 0; ///< that several ranks reported
    double median_s = 0, p95_s = 0, p99_s = 0, most_s = 0;
    double clock_error_s = 0; ///< of each, at most: what is not known of the clocks of other machines
};

/// "swap skew of 200 frames: median 0.021 ms, ... (clocks +- 0.004 ms)"
std::string to_text(SwapSkew const& skew);

class SwapLog {
public:
    /// @param time_s on the clock of the leader  @param clock_error_s  of that
    void add(std::uint64_t frame, double time_s, double clock_error_s);
    /// Of all frames so far; quantiles as gi/core/quantile.h defines them.
    SwapSkew skew() const;

private:
    struct Open {
        int ranks = 0;
        double first_s = 0, last_s = 0;
    };
    /// Reports come with a frame of delay: older frames get no more.
    static constexpr std::uint64_t kLate = 2;

    std::map<std::uint64_t, Open> open_;
    std::vector<float> skews_s_;
    double clock_error_s_ = 0;
};

} // namespace viewer
