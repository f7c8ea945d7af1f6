#pragma once
// Bootstrap over observers (Efron 1979, Ann. Stat. 7:1): trials of one person are not independent, so observers
// are resampled with replacement, not trials.

#include "study/stats/binomial.h"
#include "study/stats/pair_scale.h"

#include <cstdint>
#include <functional>
#include <span>

namespace study {

struct BootstrapSettings {
    int replicates = 1000;
    double confidence = 0.95;
    std::uint64_t seed = 1;
};

struct Bootstrap {
    /// Per number: percentiles at Phi(-sqrt(n/(n-1)) t), t the quantile of Student's distribution with n - 1 degrees:
    /// not too narrow for few observers (Hesterberg 2015, Amer. Stat. 69:371, "expanded percentile").
    std::vector<Interval> interval;
    std::vector<double> standard_error;          ///< per number: standard deviation of the replicates
    std::vector<std::vector<double>> replicates; ///< those with a result
    int failed = 0;                              ///< replicates whose observers the statistic refused
};

/// Computes numbers from the given observers, which may repeat; may throw std::invalid_argument to refuse them.
using ObserverStatistic = std::function<std::vector<double>(std::span<int const> observers)>;

/// The same seed gives the same result. @throws std::invalid_argument fewer than 2 observers, fewer than 2
/// replicates, a confidence outside (0, 1), or more than half of the replicates failed
Bootstrap bootstrap(int observers, ObserverStatistic const& statistic, BootstrapSettings const& settings = {});

/// All observers' pairs in one list; counts of pairs shown in the same order are added up.
std::vector<PairCount> pool(std::vector<std::vector<PairCount>> const& observers);

} // namespace study
