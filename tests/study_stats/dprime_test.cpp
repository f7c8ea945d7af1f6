// Sensitivity against R's psyphy and closed forms, and against observers that are simulated.

#include "study/stats/dprime.h"

#include "study/stats/random.h"
#include "study/stats/special.h"
#include "tests/study_stats/support/study_data.h"

#include <cmath>

namespace study::test {
namespace {

/// What psyphy finds by iteration misses its own equations by up to 3e-5 (R's uniroot stops at 1.2e-4):
/// for two alternatives and p = 0.6 it has 0.358264, sqrt(2) z(0.6) is 0.358287.
/// Ours solve them, as the tests below check.
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

TEST(DPrime, OfAlternativesIsThatOfPsyphy)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const cases = read_json("sdt_and_constants.expected.json")["mafc"];
    ASSERT_EQ(cases.size(), 5u);
    for (auto const& e : cases)
        for (std::size_t i = 0; i < e["pc"].size(); ++i) {
            double const d = mafc_dprime(e["pc"][i], e["m"]);
            EXPECT_NEAR(d, double(e["dprime"][i]), kUniroot) << e["m"] << " " << e["pc"][i];
            EXPECT_NEAR(mafc_proportion(d, e["m"]), double(e["pc"][i]), 1e-12);
        }
    EXPECT_NEAR(mafc_dprime(0.6, 2), std::sqrt(2.0) * normal_quantile(0.6), 1e-12);
    for (double d : {-1.0, 0.3, 2.5}) EXPECT_NEAR(mafc_proportion(d, 2), normal_cdf(d / std::sqrt(2.0)), 1e-12);
    EXPECT_NEAR(mafc_dprime(0.25, 4), 0, 1e-9);
    EXPECT_LT(mafc_dprime(0.1, 4), 0);
    EXPECT_TRUE(std::isinf(mafc_dprime(1, 3)));
}

TEST(DPrime, OfSameDifferentAndAbxIsThatOfPsyphy)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const all = read_json("sdt_and_constants.expected.json");
    auto const& sd = all["same_different"];
    EXPECT_NEAR(same_different_dprime(sd["H"], sd["FA"], Strategy::independent),
                double(sd["dprime_independent_observation"]), 1e-6);
    EXPECT_NEAR(same_different_dprime(sd["H"], sd["FA"], Strategy::differencing),
                double(sd["dprime_differencing"]), kUniroot);
    auto const& abx = all["abx"];
    EXPECT_NEAR(abx_dprime(abx["H"], abx["FA"], Strategy::differencing), double(abx["dprime_differencing"]),
                kUniroot);
}

TEST(DPrime, OfTheDifferencingModelsSolvesTheirEquations)
{
    auto const same_different_hits = [](double d, double false_alarms) {
        double const k = -std::sqrt(2.0) * normal_quantile(false_alarms / 2);
        return normal_cdf((d - k) / std::sqrt(2.0)) + normal_cdf((-d - k) / std::sqrt(2.0));
    };
    auto const abx_correct = [](double d) {
        double const a = d / std::sqrt(2.0), b = d / std::sqrt(6.0);
        return normal_cdf(a) * normal_cdf(b) + normal_cdf(-a) * normal_cdf(-b);
    };
    EXPECT_NEAR(same_different_hits(same_different_dprime(0.642, 0.3, Strategy::differencing), 0.3), 0.642, 1e-12);
    double const unbiased = normal_cdf((normal_quantile(0.75) - normal_quantile(0.3)) / 2);
    EXPECT_NEAR(abx_correct(abx_dprime(0.75, 0.3, Strategy::differencing)), unbiased, 1e-12);
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
    EXPECT_EQ(oddity_dprime(0.2), 0);
}

TEST(DPrime, OfAbxWithIndependentObservationsIsThatOfTheOptimalObserver)
{
    double const truth = 1.3;
    double const p = simulate([&](Random& r) {
        bool const x_is_a = r.below(2), a_first = r.below(2);
        double const first = r.normal() + (a_first ? truth : 0), second = r.normal() + (a_first ? 0 : truth);
        double const x = r.normal() + (x_is_a ? truth : 0);
        bool const says_first_is_a = first > second, says_x_is_a = x > truth / 2;
        return (says_first_is_a == a_first) == (says_x_is_a == x_is_a);
    });
    EXPECT_NEAR(abx_dprime(p, 1 - p, Strategy::independent), truth, 0.03);
}

TEST(DPrime, IsInfiniteWhereRatesAreAndFiniteByTheCorrection)
{
    EXPECT_TRUE(std::isinf(yes_no(10, 10, 2, 10).dprime));
    EXPECT_TRUE(std::isinf(yes_no(10, 10, 2, 10).standard_error));
    EXPECT_TRUE(std::isfinite(yes_no(10, 10, 0, 10, Correction::log_linear).dprime));
    EXPECT_EQ(same_different_dprime(0.2, 0.5, Strategy::differencing), 0);
    EXPECT_TRUE(std::isinf(same_different_dprime(0.9, 0, Strategy::differencing)));
    EXPECT_TRUE(std::isinf(abx_dprime(1, 0, Strategy::differencing)));
}

TEST(DPrime, RefusesRatesWithoutTrials)
{
    EXPECT_THROW(yes_no(0, 0, 1, 2), std::invalid_argument);
    EXPECT_THROW(yes_no(3, 2, 1, 2), std::invalid_argument);
    EXPECT_THROW(mafc_dprime(NAN, 2), std::invalid_argument);
    EXPECT_THROW(mafc_dprime(0.5, 1), std::invalid_argument);
    EXPECT_THROW(oddity_dprime(1.2), std::invalid_argument);
}

} // namespace
} // namespace study::test
