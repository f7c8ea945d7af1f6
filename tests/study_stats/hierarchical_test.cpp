// Hierarchical models against the same posterior by integration, where estimates of observers are normal.

#include "study/stats/hierarchical.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study::test {
namespace {

/// Mean of the standard deviation between observers whose estimates y have the variance v, by its reference prior
/// with a half-normal (2) bound, the mean being unknown.
double expected_deviation(std::vector<double> const& y, double v)
{
    auto const n = double(y.size());
    double mean = 0, squares = 0, sum = 0, first = 0;
    for (double const x : y) mean += x / n;
    for (double const x : y) squares += (x - mean) * (x - mean);
    for (double s = 0.0005; s < 4; s += 0.001) {
        double const total = v + s * s;
        double const density =
            s * std::pow(total, -1 - (n - 1) / 2) * std::exp(-0.5 * squares / total - s * s / 8);
        sum += density;
        first += density * s;
    }
    return first / sum;
}

TEST(Hierarchical, HasTheReferencePriorOfHowObserversDiffer)
{
    // 500 trials each; d' that differ by less than, by about as much as,
    // and by more than the error of an estimate.
    for (double const sd : {0.05, 0.11, 0.3}) {
        std::vector<DetectionCounts> people;
        std::vector<double> y;
        double v = 0;
        for (double const z : {-1.4, -0.9, -0.5, -0.1, 0.2, 0.5, 0.8, 1.4}) {
            double const d = 1 + sd * z;
            DetectionRates const r = detection_rates(DetectionTask::yes_no, d, 0);
            people.push_back({250 * r.hit.yes, 250, 250 * r.false_alarm.yes, 250});
            y.push_back(d);
            v += 1 / detection_likelihood(DetectionTask::yes_no, people.back(), d, 0).information[0] / 8;
        }
        Hierarchical const h = hierarchical_dprime(DetectionTask::yes_no, people);
        double const expected = expected_deviation(y, v);
        EXPECT_NEAR(h.deviation.mean / expected, 1, 0.06) << sd;
        EXPECT_GT(h.deviation.low, 0.005) << sd; // it vanishes at 0
        EXPECT_EQ(h.note, "") << sd;
    }
}

} // namespace
} // namespace study::test
