// Sensitivity against R's psyphy and closed forms, and against observers that are simulated.

#include "study/stats/dprime.h"

#include "study/numeric/random.h"
#include "tests/study_stats/dprime_by_rates.h"
#include "tests/study_stats/support/study_data.h"

#include <cmath>

namespace study::test {
namespace {

/// What psyphy finds by iteration misses its own equations by up to 3e-5 (R's uniroot stops at 1.2e-4):
/// for two alternatives and p = 0.6 it has 0.358264, sqrt(2) z(0.6) is 0.358287.
constexpr double kUniroot = 3e-5;

TEST(DPrime, YesNoIsTheClosedForm)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const cases = read_json("sdt_and_constants.expected.json")["yes_no"];
    ASSERT_EQ(cases.size(), 3u);
    for (auto const& e : cases) {
        YesNo const plain = yes_no(e["hits"], e["signal_trials"], e["false_alarms"], e["noise_trials"]);
        YesNo const corrected =
            yes_no(e["hits"], e["signal_trials"], e["false_alarms"], e["noise_trials"], Correction::log_linear);
        EXPECT_NEAR(plain.dprime, double(e["dprime"]), 1e-6);
        EXPECT_NEAR(plain.criterion, double(e["c"]), 1e-6);
        EXPECT_NEAR(plain.beta, double(e["beta"]), 1e-6);
        EXPECT_NEAR(corrected.dprime, double(e["loglinear_dprime"]), 1e-6);
        EXPECT_NEAR(corrected.criterion, double(e["loglinear_c"]), 1e-6);
    }
}

TEST(DPrime, OfTwoIntervalsIsThatOfPsyphy)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const e = read_json("sdt_and_constants.expected.json")["mafc"][0];
    ASSERT_EQ(e["m"], 2);
    for (std::size_t i = 0; i < e["pc"].size(); ++i)
        EXPECT_NEAR(two_interval_dprime(e["pc"][i]), double(e["dprime"][i]), kUniroot) << e["pc"][i];
    EXPECT_NEAR(two_interval_dprime(0.5), 0, 1e-9);
    EXPECT_LT(two_interval_dprime(0.1), 0);
    EXPECT_TRUE(std::isinf(two_interval_dprime(1)));
}

TEST(DPrime, OfSameDifferentAndAbxIsThatOfPsyphy)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const all = read_json("sdt_and_constants.expected.json");
    auto const& sd = all["same_different"];
    EXPECT_NEAR(same_different_dprime(sd["H"], sd["FA"]), double(sd["dprime_differencing"]), kUniroot);
    auto const& abx = all["abx"];
    EXPECT_NEAR(abx_dprime(abx["H"], abx["FA"]), double(abx["dprime_differencing"]), kUniroot);
}

/// The share of `trials` in which the observer is right.
template <class Trial>
double simulate(Trial const& right, int trials = 200000)
{
    Random random(11);
    int count = 0;
    for (int i = 0; i < trials; ++i) count += right(random);
    return double(count) / trials;
}

TEST(DPrime, OfTheOddOneOutIsThatOfASimulatedObserver)
{
    double const truth = 1.6;
    double const p = simulate([&](Random& r) {
        double const a = r.normal(), b = r.normal(), odd = r.normal() + truth;
        double const ab = std::abs(a - b);
        return ab < std::abs(a - odd) && ab < std::abs(b - odd);
    });
    EXPECT_NEAR(oddity_dprime(p), truth, 0.03);
    EXPECT_NEAR(oddity_proportion(0), 1.0 / 3, 1e-9);
    EXPECT_NEAR(oddity_proportion(1), 0.418, 5e-4); // Ennis 1993, table of the triangular method
}

TEST(DPrime, IsInfiniteWhereRatesAreAndFiniteByTheCorrection)
{
    EXPECT_TRUE(std::isinf(yes_no(10, 10, 2, 10).dprime));
    EXPECT_TRUE(std::isinf(yes_no(10, 10, 2, 10).standard_error));
    EXPECT_TRUE(std::isfinite(yes_no(10, 10, 0, 10, Correction::log_linear).dprime));
}

TEST(DPrime, RefusesRatesWithoutTrials)
{
    EXPECT_THROW(yes_no(0, 0, 1, 2), std::invalid_argument);
    EXPECT_THROW(yes_no(3, 2, 1, 2), std::invalid_argument);
    EXPECT_THROW(two_interval_dprime(NAN), std::invalid_argument);
}

} // namespace
} // namespace study::test
