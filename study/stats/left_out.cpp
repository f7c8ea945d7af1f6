#include "study/stats/left_out.h"

#include <algorithm>

namespace study {

Eigen::VectorXd change_without(std::span<PairCount const> pooled, std::span<PairCount const> own, PairModel model,
                               PairParameters const& layout, std::span<double const> at)
{
    std::vector<PairCount> others(pooled.begin(), pooled.end());
    for (PairCount const& p : own)
        for (PairCount& o : others) {
            if (o.first != p.first || o.second != p.second) continue;
            o.first_wins = std::max(0.0, o.first_wins - p.first_wins);
            o.second_wins = std::max(0.0, o.second_wins - p.second_wins);
            o.ties = std::max(0.0, o.ties - p.ties);
        }
    LikelihoodAt const penalised = with_jeffreys_prior([&](std::span<double const> x, Likelihood& l) {
        l.clear(layout.count());
        for (PairCount const& p : others) add_pair(model, layout, p, x, l);
    });
    std::vector<Bound> bounds;
    if (layout.has_threshold) {
        bounds.assign(layout.count(), {});
        bounds.back().low = kLeastTieThreshold;
    }
    constexpr int kSteps = 3;
    auto const fit = maximise(penalised, {at.begin(), at.end()}, bounds, kSteps);
    auto const n = Eigen::Index(layout.count());
    return Eigen::VectorXd::Map(at.data(), n) - Eigen::VectorXd::Map(fit.estimate.data(), n);
}

} // namespace study
