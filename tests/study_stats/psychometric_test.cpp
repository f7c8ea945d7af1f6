// Psychometric functions against R's glm, and against observers that are simulated.

#include "study/stats/group_threshold.h"
#include "study/stats/psychometric_fit.h"
#include "study/stats/psychometric_posterior.h"

#include "study/numeric/random.h"
#include "study/numeric/special.h"
#include "tests/study_stats/support/study_data.h"

#include <cmath>

namespace study::test {
namespace {

TEST(Psychometric, FitsAreThoseOfR)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const rows = read_csv("psychometric_qpdat.csv");
    auto const expected = read_json("psychometric_qpdat.expected.json");
    EXPECT_EQ(expected.size(), 12u);
    for (auto const& e : expected) {
        std::vector<LevelCount> counts;
        for (auto const& r : rows)
            if (r[0] == std::string(e["participant"]) && r[1] == std::to_string(int(e["cond"])))
                counts.push_back({std::stod(r[2]), std::stod(r[3]), std::stod(r[4])});
        bool const probit = e["link"] == "probit";
        PsychometricSettings settings;
        settings.shape.sigmoid = probit ? Sigmoid::gaussian : Sigmoid::logistic;
        PsychometricFit const f = fit_psychometric(counts, settings);
        auto const near = [&](double value, char const* name) {
            EXPECT_NEAR(value / double(e[name]), 1, 1e-6) << e.dump() << " " << name;
        };
        near(f.parameters.threshold, "threshold50");
        near(f.standard_error.threshold, "threshold_se_delta");
        near(f.parameters.scale, "scale");
        near(1 / f.parameters.scale, "slope");
        near(-f.parameters.threshold / f.parameters.scale, "intercept");
        near(f.deviance, "deviance");
        near(f.log_likelihood, "logLik");
        EXPECT_EQ(f.degrees_of_freedom, int(e["df"]));
        EXPECT_TRUE(f.converged);
        EXPECT_EQ(f.note, "");
    }
}

std::vector<LevelCount> simulated(PsychometricShape const& shape, PsychometricParameters const& truth,
                                  std::vector<double> const& levels, int trials, std::uint64_t seed = 4)
{
    Random random(seed);
    std::vector<LevelCount> counts;
    for (double const level : levels) {
        counts.push_back({level, 0, double(trials)});
        for (int t = 0; t < trials; ++t)
            counts.back().correct += random.uniform() < proportion_at(shape, truth, level);
    }
    return counts;
}

TEST(Psychometric, FindsGuessAndLapseAgainForEverySigmoidAxisAndDirection)
{
    for (Sigmoid const sigmoid : {Sigmoid::logistic, Sigmoid::gaussian, Sigmoid::weibull})
        for (Axis const axis : {Axis::linear, Axis::log10})
            for (Direction const direction : {Direction::rising, Direction::falling}) {
                PsychometricShape const shape{sigmoid, axis, direction};
                std::vector<double> levels;
                double const sign = direction == Direction::rising ? 1 : -1;
                for (double u = -3; u <= 3; u += 0.4) levels.push_back(axis == Axis::log10 ? std::pow(10, u) : u);
                PsychometricParameters const truth{0.3 * sign, 0.4, 0.25, 0.05};
                PsychometricSettings settings{shape, {0.2, 0.6}, {0.02, 0.3}};
                PsychometricFit const f = fit_psychometric(simulated(shape, truth, levels, 1500), settings);
                EXPECT_NEAR(f.parameters.threshold, truth.threshold, 4 * f.standard_error.threshold);
                EXPECT_NEAR(f.parameters.scale, truth.scale, 4 * f.standard_error.scale);
                EXPECT_NEAR(f.parameters.guess, truth.guess, 4 * f.standard_error.guess);
                EXPECT_NEAR(f.parameters.lapse, truth.lapse, 4 * f.standard_error.lapse);
                EXPECT_LT(f.standard_error.threshold, 0.05);
                EXPECT_GT(f.fit_p, 0.001);
                EXPECT_EQ(f.note, "");
                double const level = level_at(shape, f.parameters, 0.75);
                EXPECT_NEAR(proportion_at(shape, f.parameters, level), 0.75, 1e-9);
            }
}

TEST(Psychometric, WeibullOnALogarithmicAxisIsWeibull)
{
    PsychometricShape const shape{Sigmoid::weibull, Axis::log10};
    double const a = 3, b = 2.2;
    PsychometricParameters const p{std::log10(a), std::log10(std::exp(1.0)) / b, 0.5, 0.02};
    for (double x : {0.1, 1.0, 3.0, 9.0})
        EXPECT_NEAR(proportion_at(shape, p, x), 0.5 + 0.48 * (1 - std::exp(-std::pow(x / a, b))), 1e-12);
}

TEST(Psychometric, WithAForgottenLapseTheScaleIsTooLarge)
{
    // Wichmann & Hill 2001: one lapse at an easy level, and what it does.
    std::vector<LevelCount> const counts{{0, 10, 40}, {1, 14, 40}, {2, 26, 40},
                                         {3, 36, 40}, {4, 40, 40}, {9, 38, 40}};
    PsychometricSettings fixed, free;
    free.lapse = {0.01, 0.1};
    PsychometricFit const without = fit_psychometric(counts, fixed), with = fit_psychometric(counts, free);
    EXPECT_GT(without.parameters.scale, 1.2 * with.parameters.scale);
    EXPECT_GT(with.parameters.lapse, 0.01);
    EXPECT_LT(with.deviance, without.deviance);
    EXPECT_EQ(with.degrees_of_freedom, without.degrees_of_freedom - 1);
}

TEST(Psychometric, SaysWhatTheDataDoNotSettle)
{
    auto const note = [](std::vector<LevelCount> const& counts) { return fit_psychometric(counts).note; };
    std::vector<LevelCount> const step{{1, 0, 10}, {2, 0, 10}, {3, 10, 10}, {4, 10, 10}};
    EXPECT_NE(note(step), "");
    double const at = fit_psychometric(step).parameters.threshold;
    EXPECT_GE(at, 2);
    EXPECT_LE(at, 3);
    EXPECT_NE(note({{1, 0, 10}, {2, 0, 10}}).find("no correct response"), std::string::npos);
    EXPECT_NE(note({{1, 10, 10}, {2, 10, 10}}).find("nothing but correct"), std::string::npos);
    EXPECT_NE(note({{1, 5, 10}, {2, 5, 10}, {3, 5, 10}}), "");
    EXPECT_NE(note({{1, 9, 10}, {2, 5, 10}, {3, 1, 10}}), ""); // the wrong way round
}

TEST(Psychometric, LeavesOutLevelsWithoutTrialsAndAddsUpEqualOnes)
{
    std::vector<LevelCount> const counts{{1, 2, 10}, {2, 4, 10}, {3, 9, 10}};
    std::vector<LevelCount> const split{{3, 4, 4}, {1, 2, 10}, {2, 4, 10}, {5, 0, 0}, {3, 5, 6}};
    EXPECT_NEAR(fit_psychometric(counts).parameters.threshold, fit_psychometric(split).parameters.threshold, 1e-9);
    EXPECT_EQ(fit_psychometric(split).degrees_of_freedom, 1);
    auto const trials = count_levels(std::vector<double>{2, 1, 2}, std::vector<int>{1, 0, 0});
    ASSERT_EQ(trials.size(), 2u);
    EXPECT_EQ(trials[1].trials, 2);
    EXPECT_EQ(trials[1].correct, 1);
}

TEST(Psychometric, RefusesWhatIsNoCurve)
{
    auto const fit = [](std::vector<LevelCount> const& counts, PsychometricSettings const& s = {}) {
        return fit_psychometric(counts, s);
    };
    EXPECT_THROW(fit({}), std::invalid_argument);
    EXPECT_THROW(fit({{1, 2, 3}}), std::invalid_argument);
    EXPECT_THROW(fit({{1, 0, 0}, {2, 0, 0}}), std::invalid_argument);
    EXPECT_THROW(fit({{1, 4, 3}, {2, 1, 3}}), std::invalid_argument);
    EXPECT_THROW(fit({{NAN, 1, 3}, {2, 1, 3}}), std::invalid_argument);
    EXPECT_THROW(fit({{1, NAN, 3}, {2, 1, 3}}), std::invalid_argument);
    EXPECT_THROW(fit({{0, 1, 3}, {2, 1, 3}}, {{Sigmoid::logistic, Axis::log10}, {}, {}}), std::invalid_argument);
    EXPECT_THROW(fit({{1, 1, 3}, {2, 1, 3}}, {{}, {0.5, 0}, {0.02, 0.5}}), std::invalid_argument);
    EXPECT_THROW(count_levels(std::vector<double>{1, 2}, std::vector<int>{1}), std::invalid_argument);
    EXPECT_THROW(count_levels(std::vector<double>{NAN}, std::vector<int>{1}), std::invalid_argument);
    EXPECT_TRUE(std::isnan(level_at({}, {0, 1, 0.5, 0}, 0.4)));
}

/// 13 levels of 90 trials in 2-AFC, the example of psignifit (Wichmann & Hill).
std::vector<LevelCount> psignifit_example()
{
    double const right[] = {45, 50, 44, 44, 52, 53, 62, 64, 76, 79, 88, 90, 90},
                 level[] = {10, 15, 20, 25, 30, 35, 40, 45, 50, 60, 70, 80, 100};
    std::vector<LevelCount> counts;
    for (std::size_t i = 0; i < 13; ++i) counts.push_back({level[i] * 1e-4, right[i], 90});
    return counts;
}

TEST(PsychometricPosterior, IsThatOfPsignifit)
{
    PosteriorSettings settings;
    settings.low = 0.001;
    settings.high = 0.01;
    // psignifit 4.3 (PyPI), experiment_type 2AFC, sigmoid norm: means of its posterior,
    // and its interval of the threshold.
    PsychometricPosterior const all = psychometric_posterior(psignifit_example(), settings);
    EXPECT_NEAR(all.mean.threshold, 0.0046245, 5e-6);
    EXPECT_NEAR(all.mean.scale, 0.0046977 / (2 * 1.6448536), 8e-5); // its width is that from 5 % to 95 %
    EXPECT_NEAR(all.mean.lapse, 0.0053, 0.002);
    EXPECT_NEAR(all.eta, 0.0380, 0.003);
    EXPECT_GT(all.effective, 500);
    std::vector<LevelCount> third = psignifit_example();
    for (LevelCount& c : third) c = {c.level, std::floor(c.correct / 3), 30};
    PsychometricPosterior const few = psychometric_posterior(third, settings);
    EXPECT_NEAR(few.mean.threshold, 0.0047330, 1e-5);
    EXPECT_NEAR(few.eta, 0.0448, 0.004);
    PosteriorLevel const level = posterior_level(few, 0.75);
    EXPECT_LT(level.low, level.centre);
    EXPECT_GT(level.high, level.centre);
    EXPECT_NEAR(level.deviation, 0.0003, 1e-4);
}

TEST(PsychometricPosterior, RefusesWhatIsNoData)
{
    PosteriorSettings settings;
    EXPECT_THROW(psychometric_posterior({}, settings), std::invalid_argument);
    EXPECT_THROW(psychometric_posterior(std::vector<LevelCount>{{1, 3, 2}}, settings), std::invalid_argument);
    settings.high = settings.low;
    EXPECT_THROW(psychometric_posterior(std::vector<LevelCount>{{1, 1, 2}}, settings), std::invalid_argument);
    settings = {};
    PosteriorLevel const unknown =
        posterior_level(psychometric_posterior(std::vector<LevelCount>{{0.5, 1, 2}}, settings), 0.75);
    EXPECT_GT(unknown.high - unknown.low, 0.5); // two trials say little
    settings.guess = 0.995;
    EXPECT_THROW(psychometric_posterior(std::vector<LevelCount>{{0.2, 30, 30}, {0.8, 30, 30}}, settings),
                 std::invalid_argument);
}

TEST(Psychometric, ConvergesWhereLapsesAndGuessesAreFitted)
{
    int failed = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        Random random = Random::part(3, seed);
        std::vector<LevelCount> counts;
        int const levels = 5 + int(seed % 20);
        for (int i = 0; i < levels; ++i) {
            double const x = i / double(levels - 1);
            double const p = proportion_at({}, {0.5, 0.05 + 0.3 * random.uniform(), 0.5, 0.03}, x);
            LevelCount l{x, 0, double(4 + random.below(40))};
            for (int k = 0; k < l.trials; ++k) l.correct += random.uniform() < p;
            counts.push_back(l);
        }
        for (Sigmoid const kind : {Sigmoid::gaussian, Sigmoid::logistic, Sigmoid::weibull})
            failed += !fit_psychometric(counts, {{kind}, {0.5, 0}, {0.01, 0.1}}).converged;
    }
    EXPECT_EQ(failed, 0);
}

TEST(PsychometricFit, HasTheErrorOfTheLevelOfAnyProportion)
{
    // A probit model: the error of (z(share) - b0) / b1 by the delta method from those of b0 and b1.
    std::vector<LevelCount> const counts{{-2, 3, 40}, {-1, 9, 40}, {0, 22, 40}, {1, 31, 40}, {2, 38, 40}};
    PsychometricSettings settings;
    settings.guess = settings.lapse = {0, 0};
    PsychometricFit const fit = fit_psychometric(counts, settings);
    EXPECT_NEAR(standard_error_at(fit, 0.5), fit.standard_error.threshold, 1e-6);
    double const z = normal_quantile(0.9), scale = fit.parameters.scale;
    double const variance =
        fit.covariance(0, 0) + 2 * z * scale * fit.covariance(0, 1) + z * z * scale * scale * fit.covariance(1, 1);
    EXPECT_NEAR(standard_error_at(fit, 0.9), std::sqrt(variance), 1e-6);
    EXPECT_GT(standard_error_at(fit, 0.9), 1.2 * standard_error_at(fit, 0.5));
}

TEST(Trend, IsThatWithinObserversAndNeedsTwoLevels)
{
    Trend flat;
    flat.add(0.1, 9, 17);
    EXPECT_FALSE(flat.is_falling()) << "one level";
    // Two good observers at hard levels, one at chance at easy ones.
    Trend trend;
    for (int good = 0; good < 2; ++good) {
        trend.add(1, 30, 40);
        trend.add(2, 36, 40);
        trend.next_observer();
    }
    trend.add(5, 20, 40);
    trend.add(6, 20, 40);
    EXPECT_FALSE(trend.is_falling());
    Trend falling;
    falling.add(1, 36, 40);
    falling.add(2, 26, 40);
    EXPECT_TRUE(falling.is_falling());
}

TEST(PsychometricFit, SaysThatResponsesChangeInTheWrongDirection)
{
    std::vector<LevelCount> counts{{1, 38, 40}, {2, 33, 40}, {3, 25, 40}, {4, 21, 40}};
    PsychometricSettings settings;
    EXPECT_NE(fit_psychometric(counts, settings).note.find(kWrongDirection), std::string::npos);
    settings.shape.direction = Direction::falling;
    EXPECT_EQ(fit_psychometric(counts, settings).note.find(kWrongDirection), std::string::npos);
    ObserverLevels const one{counts, 0.5};
    GroupThresholdSettings group{settings.shape, 0.75, 1, 4};
    EXPECT_EQ(group_threshold(std::span(&one, 1), group).note, "");
    group.shape.direction = Direction::rising;
    EXPECT_NE(group_threshold(std::span(&one, 1), group).note.find(kWrongDirection), std::string::npos);
}

TEST(GroupThreshold, OfEqualObserversHasStudentsIntervalFarOffToo)
{
    // The spread that is most likely is 0; at the ends of wide intervals it is not.
    ObserverLevels const one{{{1, 41, 80}, {2, 46, 80}, {3, 60, 80}, {4, 74, 80}, {5, 79, 80}}, 0.5};
    std::vector<ObserverLevels> const observers(3, one);
    GroupThresholdSettings settings{{}, 0.75, 1, 5};
    auto const width = [&](double confidence) {
        settings.confidence = confidence;
        Interval const i = group_threshold(observers, settings).interval;
        return i.high - i.low;
    };
    double const expected = student_quantile(0.9995, 2) / student_quantile(0.975, 2);
    EXPECT_NEAR(width(0.999) / width(0.95), expected, 0.2 * expected);
}

} // namespace
} // namespace study::test
