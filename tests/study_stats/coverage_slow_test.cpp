// Do intervals that say 95 % hold the truth in 95 % of experiments?

#include "study/stats/bootstrap.h"
#include "study/stats/psychometric.h"

#include "study/stats/random.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study::test {
namespace {

TEST(Coverage, OfObserverBootstrapIntervalsOfScoresIs93To97PerCent)
{
    // Scores of people differ: each has a scale of his or her own around that of all. What is estimated is then
    // not the mean scale but that of their pooled choices, whose model is Thurstone's too: variances add.
    int const simulations = 2000, observers = 24, repeats = 3, items = 4;
    double const between = 0.5, truth[items] = {-0.9, -0.1, 0.3, 0.7};
    double const shrunk = 1 / std::sqrt(1 + 2 * between * between); // of a difference of two people's items
    double const jod = jod_per_unit(PairModel::thurstone_v);
    int covered[items] = {};
    for (int s = 0; s < simulations; ++s) {
        Random random = Random::part(20261, std::uint64_t(s));
        std::vector<std::vector<PairCount>> data;
        for (int o = 0; o < observers; ++o) {
            double own[items];
            for (int i = 0; i < items; ++i) own[i] = truth[i] + between * random.normal();
            data.emplace_back();
            for (int i = 0; i < items; ++i)
                for (int j = i + 1; j < items; ++j) {
                    PairCount pair{i, j};
                    for (int r = 0; r < repeats; ++r)
                        (own[i] - own[j] + random.normal() > 0 ? pair.first_wins : pair.second_wins) += 1;
                    data.back().push_back(pair);
                }
        }
        Bootstrap const b = bootstrap_pairs(data, items, {}, {.replicates = 300, .seed = std::uint64_t(s)});
        for (int i = 0; i < items; ++i) {
            double const value = truth[i] * shrunk * jod;
            covered[i] += b.interval[std::size_t(i)].low <= value && value <= b.interval[std::size_t(i)].high;
        }
    }
    for (int i = 0; i < items; ++i) {
        double const share = double(covered[i]) / simulations;
        RecordProperty("coverage_" + std::to_string(i), std::to_string(share));
        EXPECT_GE(share, 0.93) << "item " << i;
        EXPECT_LE(share, 0.97) << "item " << i;
    }
}

TEST(Coverage, OfSimulatedObserversThresholdsIs93To97PerCent)
{
    PsychometricSettings const settings{{}, {0.5, 0}, {0.02, 0}};
    PsychometricParameters const truth{0.4, 1.1, 0.5, 0.02};
    int const simulations = 2000, trials = 120;
    int covered = 0;
    for (int s = 0; s < simulations; ++s) {
        Random random = Random::part(7, std::uint64_t(s));
        std::vector<LevelCount> counts;
        for (double level : {-2.0, -1.0, 0.0, 0.5, 1.0, 2.0, 3.5}) {
            counts.push_back({level, 0, double(trials)});
            for (int t = 0; t < trials; ++t)
                counts.back().correct += random.uniform() < proportion_at(settings.shape, truth, level);
        }
        PsychometricFit const fit = fit_psychometric(counts, settings);
        covered += std::abs(fit.parameters.threshold - truth.threshold) <= 1.959964 * fit.standard_error.threshold;
    }
    RecordProperty("threshold", std::to_string(double(covered) / simulations));
    EXPECT_GE(double(covered) / simulations, 0.93);
    EXPECT_LE(double(covered) / simulations, 0.97);
}

} // namespace
} // namespace study::test
