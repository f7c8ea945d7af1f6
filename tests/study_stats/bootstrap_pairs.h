#pragma once
// Bootstrap of the scores of fit_pairs (in JOD, mean 0): what the errors over observers are compared with.

#include "study/stats/bootstrap.h"

namespace study::test {

/// @param observers  the pairs of each @throws std::invalid_argument as bootstrap and fit_pairs
inline Bootstrap bootstrap_pairs(std::vector<std::vector<PairCount>> const& observers, int items,
                                 BootstrapSettings const& settings)
{
    auto const scores = [&](std::span<int const> drawn) {
        std::vector<std::vector<PairCount>> sample;
        for (int const d : drawn) sample.push_back(observers[std::size_t(d)]);
        std::vector<double> score = fit_pairs(pool(sample), items).score;
        for (double& s : score) s *= jod_per_unit(PairModel::thurstone_v);
        return score;
    };
    return bootstrap(int(observers.size()), scores, settings);
}

} // namespace study::test
