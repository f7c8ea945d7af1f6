// Do intervals that say 95 % hold the truth in 95 % of experiments?

#include "study/numeric/special.h"
#include "study/stats/observer_scale.h"
#include "study/stats/psychometric_fit.h"
#include "study/stats/ratings.h"

#include "study/numeric/random.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

namespace study::test {
namespace {

/// A simulated experiment of pairs. Scores of people differ: each has a scale of his or her own around that of
/// all, whose unit may differ too. What is estimated is that of their pooled choices.
struct PairExperiment {
    char const* name;
    std::vector<double> truth;
    int observers, repeats;
    double between;      ///< standard deviation of an observer's scores
    double tie = 0;      ///< smaller differences are ties
    double unit_sd = 0;  ///< of the logarithm of an observer's unit
    double missing = 0;  ///< share of pairs that an observer does not judge
    int disputed = -1;   ///< an item of which the spread is 1
    double least = 0.93; ///< coverage of an item

    double spread(std::size_t item) const { return int(item) == disputed ? 1 : between; }
};

std::vector<PairCount> choices_of(PairExperiment const& e, Random& random)
{
    double const unit = std::exp(e.unit_sd * random.normal());
    std::vector<double> own;
    for (std::size_t i = 0; i < e.truth.size(); ++i)
        own.push_back(unit * e.truth[i] + e.spread(i) * random.normal());
    std::vector<PairCount> pairs;
    for (int i = 0; i < int(own.size()); ++i)
        for (int j = i + 1; j < int(own.size()); ++j) {
            if (random.uniform() < e.missing) continue;
            PairCount p{i, j};
            for (int r = 0; r < e.repeats; ++r) {
                double const d = own[std::size_t(i)] - own[std::size_t(j)] + random.normal();
                (std::abs(d) < e.tie ? p.ties : d > 0 ? p.first_wins : p.second_wins) += 1;
            }
            pairs.push_back(p);
        }
    return pairs;
}

/// Scores of infinitely many observers: variances between people add to those of trials.
std::vector<double> scores_of_all(PairExperiment const& e, PairSettings const& settings)
{
    int const units = e.unit_sd > 0 ? 2000 : 1;
    std::vector<PairCount> pairs;
    for (int i = 0; i < int(e.truth.size()); ++i)
        for (int j = i + 1; j < int(e.truth.size()); ++j) {
            PairCount p{i, j};
            double const shrunk = 1 / std::hypot(1, e.spread(std::size_t(i)), e.spread(std::size_t(j)));
            for (int u = 0; u < units; ++u) {
                double const unit = e.unit_sd > 0 ? std::exp(e.unit_sd * normal_quantile((u + 0.5) / units)) : 1;
                double const d = unit * (e.truth[std::size_t(i)] - e.truth[std::size_t(j)]);
                p.first_wins += 1e6 / units * normal_cdf((d - e.tie) * shrunk);
                p.second_wins += 1e6 / units * normal_cdf((-d - e.tie) * shrunk);
            }
            if (e.tie > 0) p.ties = 1e6 - p.first_wins - p.second_wins;
            pairs.push_back(p);
        }
    return fit_pairs(pairs, int(e.truth.size()), settings).score;
}

TEST(Coverage, OfScoresOfPairsIs93To97PerCentInManyKindsOfExperiments)
{
    std::vector<double> const mid{-0.9, -0.1, 0.3, 0.7}, wide{-2.2, -1, 0.2, 1, 2},
        seven{-1.5, -1, -.4, 0, .4, 1, 1.5}, twelve{-1.6, -1.3, -1, -.7, -.4, -.1, .2, .5, .8, 1.1, 1.4, 1.1};
    std::vector<PairExperiment> const all{{"few", mid, 8, 3, 0.5},
                                          {"usual", mid, 24, 3, 0.5},
                                          {"many, one trial each", mid, 60, 1, 0.3},
                                          {"no spread", mid, 12, 1, 0},
                                          {"wide, few", wide, 8, 2, 0.3},
                                          {"wide, one trial each", wide, 20, 1, 0.3},
                                          {"wide", wide, 40, 2, 0.5},
                                          {"ties", mid, 12, 2, 0.3, 0.5},
                                          {"ties, wide", wide, 20, 1, 0.3, 0.4},
                                          {"unequal units", mid, 16, 3, 0.2, 0, 0.5},
                                          {"unequal units, wide", wide, 30, 2, 0.2, 0, 0.5},
                                          {"gaps", mid, 16, 2, 0.4, 0, 0, 0.4},
                                          {"seven items", seven, 30, 1, 0.7},
                                          {"very different people", mid, 20, 6, 0.8},
                                          {"one disputed of twelve", twelve, 24, 1, 0.2, 0, 0, 0, 6},
                                          {"one end disputed", seven, 16, 2, 0.1, 0, 0, 0, 6, 0.92},
                                          {"unequal units, wide, one trial each", wide, 20, 1, 0.2, 0, 0.5},
                                          {"no differences", {0, 0, 0, 0, 0}, 20, 2, 0.3}};
    int const simulations = 5000;
    for (PairExperiment const& e : all) {
        PairSettings settings;
        if (e.tie > 0) settings.ties = TieModel::threshold;
        std::vector<double> const truth = scores_of_all(e, settings);
        std::vector<double> covered(truth.size(), 0);
        double bias = 0, reduced = 0, mean_covered = 0;
        for (int s = 0; s < simulations; ++s) {
            Random random = Random::part(20261, std::uint64_t(s));
            std::vector<std::vector<PairCount>> data;
            for (int o = 0; o < e.observers; ++o) data.push_back(choices_of(e, random));
            ObserverScale const scale = scale_observers(data, int(truth.size()), settings);
            for (std::size_t i = 0; i < truth.size(); ++i) {
                Contrast const c = score_of(scale, int(i));
                covered[i] += (c.interval.low <= truth[i] && truth[i] <= c.interval.high) / double(simulations);
            }
            double const range = truth.back() > 0.1 ? truth.back() - truth.front() : kInfinity;
            bias +=
                ((scale.fit.score.back() - scale.fit.score.front()) / range - (range < kInfinity)) / simulations;
            reduced += ((scale.reduced.score.back() - scale.reduced.score.front()) / range - (range < kInfinity)) /
                       simulations;
        }
        for (double const c : covered) {
            EXPECT_GE(c, e.least) << e.name;
            EXPECT_LE(c, 0.98) << e.name;
            mean_covered += c / double(truth.size());
        }
        EXPECT_GE(mean_covered, 0.935) << e.name;
        EXPECT_LE(mean_covered, 0.97) << e.name;
        EXPECT_LT(std::abs(reduced), 0.035) << e.name;
        std::printf("%-24s coverage %.3f (%.3f to %.3f), bias of the range %+.3f, reduced %+.3f\n", e.name,
                    mean_covered, *std::min_element(covered.begin(), covered.end()),
                    *std::max_element(covered.begin(), covered.end()), bias, reduced);
    }
}

TEST(Coverage, OfMeanRatingsIs93To97PerCentAlsoNearTheEndOfTheScale)
{
    int const simulations = 4000;
    for (int const people : {8, 12, 24})
        for (double const quality : {4.0, 5.5, 6.3, 6.8})
            for (int const repeats : {1, 3}) {
                auto const rating = [&](Random& random) {
                    double const bias = 0.6 * random.normal();
                    double sum = 0;
                    for (int r = 0; r < repeats; ++r)
                        sum += std::clamp(std::round(quality + bias + 0.9 * random.normal()), 1.0, 7.0);
                    return sum / repeats;
                };
                Random all(5);
                double truth = 0;
                for (int i = 0; i < 200000; ++i) truth += rating(all) / 200000;
                double skewed = 0, student = 0;
                for (int s = 0; s < simulations; ++s) {
                    Random random = Random::part(11, std::uint64_t(s));
                    Matrix ratings(1, std::size_t(people));
                    for (double& r : ratings.values) r = rating(random);
                    MeanOpinion const m = mean_opinions(ratings).front();
                    skewed += m.skewed.low <= truth && truth <= m.skewed.high;
                    student += m.interval.low <= truth && truth <= m.interval.high;
                }
                std::printf("%2d observers, quality %.1f, %d repeats: %.3f, Student's %.3f\n", people, quality,
                            repeats, skewed / simulations, student / simulations);
                EXPECT_GE(skewed / simulations, 0.93);
                EXPECT_LE(skewed / simulations, 0.98);
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
