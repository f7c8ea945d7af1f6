// Active sampling of pairs: the posterior, the expected gain, and what it chooses.

#include "study/adaptive/active_pairs.h"
#include "study/numeric/special.h"
#include "study/stats/pair_scale.h"
#include "tests/study_adaptive/pair_mode.h"

#include <array>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <set>

namespace study {
namespace {

std::vector<ActivePairs::Pair> all_pairs(int n)
{
    std::vector<ActivePairs::Pair> pairs;
    for (int a = 0; a < n; ++a)
        for (int b = a + 1; b < n; ++b) pairs.emplace_back(a, b);
    return pairs;
}

TEST(ActivePairs, GainIsTheFallOfTheVariancesAroundTheMean)
{
    ActivePairs pairs(3, all_pairs(3), {true, 1, 7});
    pairs.shown({0, 1}, 1);
    pairs.shown({0, 2}, 1);
    pairs.shown({1, 2}, 0);
    auto const spread = [](Matrix const& c) {
        double trace = 0, sum = 0;
        for (std::size_t i = 0; i < c.rows; ++i) trace += c(i, i);
        for (double const v : c.values) sum += v;
        return trace - sum / double(c.rows);
    };
    for (auto const& pair : all_pairs(3)) {
        auto const a = std::size_t(pair.first), b = std::size_t(pair.second);
        Matrix c = pairs.covariance();
        double const v = c(a, a) + c(b, b) - 2 * c(a, b);
        double const d = std::max(0.0, std::abs(pairs.scores()[a] - pairs.scores()[b]) - std::sqrt(v));
        double const p = normal_cdf(d), w = normal_pdf(d) * normal_pdf(d) / (p * (1 - p));
        double const before = spread(c);
        std::vector<double> along;
        for (std::size_t i = 0; i < 3; ++i) along.push_back(c(i, a) - c(i, b));
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) c(i, j) -= along[i] * along[j] * w / (1 + w * v);
        EXPECT_NEAR(pairs.gain(pair), before - spread(c), 1e-9) << a << " " << b;
    }
}

/// Mean of f over the posterior of three scores by sums over a grid of the differences to the first.
double mean_over_posterior(std::vector<PairAnswer> const& answers, double prior_sd,
                           std::function<double(double, double)> const& f)
{
    double sum = 0, total = 0;
    for (double x = -12; x < 12; x += 0.1)
        for (double y = -12; y < 12; y += 0.1) {
            std::array<double, 3> const s{0, x, y};
            // The prior on differences: independent scores minus their mean.
            double const mean = (x + y) / 3;
            double log_p =
                -(mean * mean + (x - mean) * (x - mean) + (y - mean) * (y - mean)) / 2 / (prior_sd * prior_sd);
            for (PairAnswer const& a : answers) {
                double const d = s[std::size_t(a.pair.first)] - s[std::size_t(a.pair.second)];
                log_p += a.first_wins * log_normal_cdf(d) + (1 - a.first_wins) * log_normal_cdf(-d);
            }
            double const p = std::exp(log_p);
            sum += p * f(x, y);
            total += p;
        }
    return sum / total;
}

TEST(ActivePairs, PosteriorIsThatOfNumericalIntegration)
{
    // The first wins nearly always: a skewed posterior.
    std::vector<PairAnswer> answers(6, {{0, 1}, 1});
    answers.insert(answers.end(), 4, {{2, 0}, 0});
    answers.insert(answers.end(), 3, {{1, 2}, 1});
    answers.push_back({{1, 2}, 0});
    answers.push_back({{1, 2}, 0.5});
    RunningPairPosterior running(3, 1.5);
    for (PairAnswer const& a : answers) running.add(a);
    running.refine();
    auto const& m = running.mean();
    EXPECT_NEAR(m[0] + m[1] + m[2], 0, 1e-9);
    for (auto const& pair : all_pairs(3)) {
        auto const of = [&](double x, double y) {
            std::array<double, 3> const s{0, x, y};
            return s[std::size_t(pair.first)] - s[std::size_t(pair.second)];
        };
        double const mean = mean_over_posterior(answers, 1.5, of);
        double const variance =
            mean_over_posterior(answers, 1.5, [&](double x, double y) { return std::pow(of(x, y) - mean, 2); });
        EXPECT_NEAR(m[std::size_t(pair.first)] - m[std::size_t(pair.second)], mean, 0.01) << pair.second;
        // The approximation at the mode is up to 30 % off here.
        EXPECT_NEAR(difference_variance(running.covariance(), pair), variance, 0.1 * variance) << pair.second;
    }
}

TEST(ActivePairs, PosteriorModeIsThatOfFitPairsWithAWidePrior)
{
    std::vector<PairCount> const counts{{0, 1, 6, 4, 0}, {1, 2, 7, 3, 0}, {0, 2, 9, 2, 0}};
    std::vector<PairAnswer> answers;
    for (PairCount const& c : counts) {
        for (int i = 0; i < int(c.first_wins); ++i) answers.push_back({{c.first, c.second}, 1});
        for (int i = 0; i < int(c.second_wins); ++i) answers.push_back({{c.first, c.second}, 0});
    }
    PairPosterior const posterior = pair_posterior(3, answers, 1000);
    PairScale const fit = fit_pairs(counts, 3);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(posterior.mode[i], fit.score[i], 1e-4) << i;
}

TEST(ActivePairs, RunningPosteriorWithManyAnswersIsThatAtTheMode)
{
    Random random(11);
    std::vector<PairAnswer> answers;
    RunningPairPosterior running(4, 3);
    for (int i = 0; i < 3000; ++i)
        for (auto const& pair : all_pairs(4)) {
            double const p = normal_cdf(0.4 * (pair.first - pair.second));
            answers.push_back({pair, random.uniform() < p ? 1.0 : 0.0});
            running.add(answers.back());
        }
    running.refine();
    PairPosterior const at_mode = pair_posterior(4, answers, 3);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(running.mean()[i], at_mode.mode[i], 2e-3);
    for (auto const& pair : all_pairs(4)) {
        double const v = difference_variance(at_mode.covariance, pair);
        EXPECT_NEAR(difference_variance(running.covariance(), pair), v, 0.01 * v);
    }
}

TEST(ActivePairs, ATreeConnectsAllItems)
{
    ActivePairs pairs(7, all_pairs(7), {true, 3, 5});
    for (int tree = 0; tree < 5; ++tree) {
        std::set<int> seen;
        std::set<ActivePairs::Pair> edges;
        for (int i = 0; i < 6; ++i) {
            auto const p = pairs.next();
            seen.insert({p.first, p.second});
            EXPECT_TRUE(edges.insert(p).second) << "twice in a tree";
            pairs.shown(p, p.first < p.second ? 1 : 0);
        }
        EXPECT_EQ(seen.size(), 7u);
    }
}

TEST(ActivePairs, DependOnSeedAndAnswersOnly)
{
    for (bool const is_tree : {true, false}) {
        auto const run = [&](std::uint64_t seed, int flip) {
            ActivePairs pairs(5, all_pairs(5), {is_tree, 3, seed});
            std::vector<ActivePairs::Pair> shown;
            for (int i = 0; i < 24; ++i) {
                shown.push_back(pairs.next());
                pairs.shown(shown.back(), i == flip ? 0.0 : 1.0);
            }
            return shown;
        };
        EXPECT_EQ(run(1, -1), run(1, -1));
        EXPECT_NE(run(1, -1), run(2, -1));
        EXPECT_NE(run(1, -1), run(1, 2));
    }
}

TEST(ActivePairs, AreNotTheSameTwiceInARow)
{
    ActivePairs pairs(3, all_pairs(3), {});
    for (int i = 0; i < 60; ++i) {
        auto const p = pairs.next();
        pairs.shown(p, p == ActivePairs::Pair{0, 1} ? i % 2 : 1); // all that is open is the order of 0 and 1
        EXPECT_NE(pairs.next(), p);
    }
    ActivePairs only(2, all_pairs(2), {});
    only.shown({0, 1}, 1);
    EXPECT_EQ(only.next(), (ActivePairs::Pair{0, 1}));
}

TEST(ActivePairs, AreNotThoseWhoseOrderIsKnown)
{
    // Ten levels 1 JOD apart: neighbours say more about the scale than the two ends.
    Random random(3);
    ActivePairs pairs(10, all_pairs(10), {true, 3, 9});
    int near = 0, far = 0;
    for (int i = 0; i < 270; ++i) {
        auto const [a, b] = pairs.next();
        double const p = normal_cdf((a - b) / 1.4826);
        near += b - a <= 2;
        far += b - a >= 6;
        pairs.shown({a, b}, random.uniform() < p ? 1 : 0);
    }
    EXPECT_GT(near, 1.3 * 270 * 17 / 45.0) << "17 of 45 pairs";
    EXPECT_LT(far, 0.7 * 270 * 10 / 45.0) << "10 of 45 pairs";
}

TEST(ActivePairs, RefuseWhatCannotBeShown)
{
    EXPECT_THROW(ActivePairs(3, {}, {}), std::invalid_argument);
    EXPECT_THROW(ActivePairs(3, {{0, 3}}, {}), std::invalid_argument);
    EXPECT_THROW(ActivePairs(3, {{1, 1}}, {}), std::invalid_argument);
}

} // namespace
} // namespace study
