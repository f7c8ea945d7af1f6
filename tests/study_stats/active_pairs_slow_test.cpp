// How many trials active sampling of pairs needs for the error that random pairs leave: table on stdout, worst
// first.

#include "study/stats/active_pairs.h"
#include "study/stats/special.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <gtest/gtest.h>

namespace study {
namespace {

constexpr double kJod = 1.4826022185056018; ///< JOD per unit of F

struct Shape {
    std::string name;
    std::vector<double> jod;
};

std::vector<double> spaced(int n, double step)
{
    std::vector<double> s;
    for (int i = 0; i < n; ++i) s.push_back(i * step);
    return s;
}

std::vector<Shape> shapes()
{
    std::vector<Shape> all;
    for (int const n : {5, 10, 20, 30}) {
        std::string const items = std::to_string(n) + " conditions, ";
        all.push_back({items + "even, 0.25 JOD apart", spaced(n, 0.25)});
        all.push_back({items + "even, 1 JOD apart", spaced(n, 1)});
        std::vector<double> normal, clusters, stretched;
        for (int i = 0; i < n; ++i) {
            normal.push_back(2 * normal_quantile((i + 0.5) / n));
            clusters.push_back(6 * (i % 2) + 0.2 * i);
            stretched.push_back(10 * std::pow(double(i) / (n - 1), 2));
        }
        all.push_back({items + "normal, SD 2 JOD", normal});
        all.push_back({items + "two clusters 6 JOD apart", clusters});
        all.push_back({items + "square law over 10 JOD", stretched});
    }
    return all;
}

std::vector<ActivePairs::Pair> all_pairs(int n)
{
    std::vector<ActivePairs::Pair> pairs;
    for (int a = 0; a < n; ++a)
        for (int b = a + 1; b < n; ++b) pairs.emplace_back(a, b);
    return pairs;
}

/// Root mean square of score errors in JOD, both with mean 0.
double error_of(std::vector<double> const& scores, std::vector<double> const& truth)
{
    double mean = 0, sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) mean += (scores[i] * kJod - truth[i]) / double(truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
        double const e = scores[i] * kJod - truth[i] - mean;
        sum += e * e;
    }
    return std::sqrt(sum / double(truth.size()));
}

using Next = std::function<ActivePairs::Pair()>;
using Learn = std::function<void(ActivePairs::Pair, double)>;

/// Squared errors after each checkpoint of one simulated experiment. Both ways of sampling get the same estimate,
/// the posterior mode with the sampler's prior, which is finite for all data.
void experiment(Shape const& shape, std::vector<int> const& checkpoints, Random& random, Next const& next,
                Learn const& learn, std::vector<double>& squares)
{
    int const n = int(shape.jod.size());
    std::vector<PairAnswer> answers;
    std::size_t c = 0;
    for (int trial = 1; c < checkpoints.size(); ++trial) {
        auto const [a, b] = next();
        double const d = (shape.jod[std::size_t(a)] - shape.jod[std::size_t(b)]) / kJod;
        double const wins = random.uniform() < normal_cdf(d) ? 1 : 0;
        learn({a, b}, wins);
        answers.push_back({{a, b}, wins});
        if (trial != checkpoints[c]) continue;
        double const e = error_of(pair_posterior(n, answers, 3).mode, shape.jod);
        squares[c++] += e * e;
    }
}

TEST(ActivePairsSlow, NeedFewerTrialsThanRandomPairs)
{
    constexpr int kExperiments = 40;
    struct Row {
        std::string name;
        int trials;
        double error, share;
    };
    std::vector<Row> rows;
    for (Shape const& shape : shapes()) {
        int const n = int(shape.jod.size()), pairs = n * (n - 1) / 2;
        // Random pairs: each pair three times (at least 15 trials a condition); active: after each tenth of that.
        int const full = std::max(3 * pairs, 15 * n) / 10 * 10;
        std::vector<int> checkpoints;
        for (int i = 2; i <= 10; ++i) checkpoints.push_back(full * i / 10);
        std::vector<double> by_chance(1, 0), active(checkpoints.size(), 0);
        for (int e = 0; e < kExperiments; ++e) {
            Random random = Random::part(20261126, std::uint64_t(e));
            std::vector<ActivePairs::Pair> list;
            auto const next = [&] {
                if (list.empty()) {
                    list = all_pairs(n);
                    random.shuffle(list);
                }
                auto const p = list.back();
                list.pop_back();
                return p;
            };
            experiment(
                shape, {full}, random, next, [](auto, double) {}, by_chance);
            ActivePairs sampler(n, all_pairs(n), {true, 3, std::uint64_t(e)});
            experiment(
                shape, checkpoints, random, [&] { return sampler.next(); },
                [&](ActivePairs::Pair p, double wins) { sampler.shown(p, wins); }, active);
        }
        double const wanted = std::sqrt(by_chance[0] / kExperiments);
        double share = 1;
        for (std::size_t c = checkpoints.size(); c-- > 0;) {
            double const error = std::sqrt(active[c] / kExperiments);
            if (error > wanted) {
                if (c + 1 == checkpoints.size()) {
                    share = 1.01; // more than all
                    break;
                }
                double const next_error = std::sqrt(active[c + 1] / kExperiments);
                double const part = (error - wanted) / (error - next_error);
                share = (checkpoints[c] + part * (checkpoints[c + 1] - checkpoints[c])) / double(full);
                break;
            }
            share = checkpoints[c] / double(full);
        }
        rows.push_back({shape.name, full, wanted, share});
        std::fprintf(stderr, "%s: %d %.3f %.3f\n", shape.name.c_str(), full, wanted, share);
    }
    std::sort(rows.begin(), rows.end(), [](Row const& a, Row const& b) { return a.share > b.share; });
    std::printf("| scale | random trials | error, JOD | active trials for it |\n|---|---|---|---|\n");
    for (Row const& r : rows)
        std::printf("| %s | %d | %.3f | %s%.0f %% |\n", r.name.c_str(), r.trials, r.error,
                    r.share > 1 ? "more than " : "", 100 * std::min(1.0, r.share));
    // Compact scales gain nothing (docs/results/2026-11-26-study-active-pairs.md); long even ones must.
    for (Row const& r : rows) {
        bool const is_long =
            r.name.starts_with("10 conditions, even, 1 JOD") || r.name.starts_with("20 conditions, even, 1 JOD");
        if (is_long) {
            EXPECT_LE(r.share, 0.65) << r.name;
        }
    }
}

} // namespace
} // namespace study
