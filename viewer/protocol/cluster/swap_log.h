#pragma once
// Statistics of the swap skew between the ranks of a cluster.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace viewer {

/// Time from the first rank's swap to the last rank's, s.
struct SwapSkew {
    std::uint64_t frames = 0; ///< frames reported by several ranks
    double median_s = 0, p95_s = 0, p99_s = 0, most_s = 0;
    double clock_error_s = 0; ///< maximum error of each skew from the clock offsets of other machines
};

/// "swap skew of 200 frames: median 0.021 ms, ... (clocks +- 0.004 ms)"
std::string to_text(SwapSkew const& skew);

class SwapLog {
public:
    /// @param time_s  on the leader's clock  @param clock_error_s  of time_s
    void add(std::uint64_t frame, double time_s, double clock_error_s);
    /// Skew of all frames so far; quantiles as defined in gi/core/quantile.h.
    SwapSkew skew() const;

private:
    struct Open {
        int ranks = 0;
        double first_s = 0, last_s = 0;
    };
    /// Reports arrive one frame late; frames older than this get no more reports.
    static constexpr std::uint64_t kLate = 2;

    std::map<std::uint64_t, Open> open_;
    std::vector<float> skews_s_;
    double clock_error_s_ = 0;
};

} // namespace viewer
