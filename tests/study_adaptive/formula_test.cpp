// Formulas of psychometric functions: parsing, values, errors with columns; the named curves; fits.

#include "study/adaptive/formula.h"
#include "study/adaptive/questplus.h"
#include "study/adaptive/sigmoid.h"
#include "study/stats/psychometric_fit.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study {
namespace {

double value(std::string const& text) { return Formula(text, {"x", "y"}, 0)(std::array{2.0, 3.0}); }

TEST(Formula, ComputesAsWritten)
{
    for (auto const& [text, expected] : {
             std::pair{"1 + 2 * 3", 7.0},
             {"(1 + 2) * 3", 9},
             {"2 ^ 3 ^ 2", 512},
             {"-x ^ 2", -4},
             {"2 ^ -1", 0.5},
             {"8 - 3 - 2", 3},
             {"8 / 4 / 2", 1},
             {"x * y - y / x", 4.5},
             {"exp(log(x))", 2},
             {"log10(100)", 2},
             {"log2(8)", 3},
             {"sqrt(y * 3)", 3},
             {"abs(-x)", 2},
             {"min(x, y)", 2},
             {"max(x, y)", 3},
             {"normal(0)", 0.5},
             {"erf(0)", 0},
             {"tanh(0)", 0},
             {"4 * atan(1) - pi", 0},
             {"1e-1 + .5", 0.6},
             {"--x", 2},
             {"1-exp(-(x/y)^2)", -std::expm1(-4.0 / 9)},
         })
        EXPECT_NEAR(value(text), expected, 1e-12) << text;
    EXPECT_TRUE(std::isnan(value("log(-x)")));
}

TEST(Formula, SaysWhereItIsWrong)
{
    for (auto const& [text, column, mentions] : {
             std::tuple{"x + ", 5, "ends here"},
             {"x + z", 5, "did you mean 'x'?"},
             {"exp x", 5, "without '('"},
             {"(x + y", 7, "not closed"},
             {"x y", 3, "an operator is missing"},
             {"x + * y", 5, "needed here"},
             {"min(x)", 6, "needs two"},
             {"exq(x)", 1, "did you mean 'exp'?"},
             {"", 1, "ends here"},
             {"x; system(1)", 2, "an operator is missing"},
             {"x = y", 3, "an operator is missing"},
         }) {
        try {
            value(text);
            FAIL() << text;
        } catch (FormulaError const& e) {
            EXPECT_EQ(e.column, column) << text << "\n" << e.what();
            EXPECT_NE(std::string(e.what()).find(mentions), std::string::npos) << text << "\n" << e.what();
        }
    }
    EXPECT_THROW(value(std::string(2000, '(')), FormulaError);
    EXPECT_THROW(value(std::string(500, '(') + "x"), FormulaError);
    EXPECT_THROW(value(std::string(500, '-') + "x"), FormulaError);
    EXPECT_THROW(Formula::psychometric("guess + slope"), FormulaError) << "without x";
}

TEST(Sigmoids, AreDistributionsWithTheirDensityAndQuantile)
{
    for (Sigmoid const kind : {Sigmoid::logistic, Sigmoid::gaussian, Sigmoid::weibull, Sigmoid::gumbel_right,
                               Sigmoid::hyperbolic_secant, Sigmoid::cauchy}) {
        double last = 0;
        for (double z = -6; z <= 6; z += 0.25) {
            SigmoidValue const v = sigmoid(kind, z);
            double const h = 1e-6;
            EXPECT_NEAR(v.below + v.above, 1, 1e-14) << int(kind) << " " << z;
            EXPECT_NEAR(v.density, (sigmoid(kind, z + h).below - sigmoid(kind, z - h).below) / (2 * h), 1e-8);
            EXPECT_GE(v.below, last);
            last = v.below;
            if (v.below > 1e-12 && v.above > 1e-12) {
                EXPECT_NEAR(sigmoid_quantile(kind, v.below), z,
                            1e-6 * std::max(1.0, std::abs(z)) / v.density * 1e-3 + 1e-9)
                    << int(kind);
            }
        }
    }
}

/// Exact proportions as counts: the fit must return the parameters.
TEST(Formulas, FitAsTheFunctionsThatTheyWrite)
{
    std::vector<LevelCount> counts;
    PsychometricShape weibull{Sigmoid::weibull, Axis::log10, Direction::rising};
    double const threshold = 12, slope = 2.5;
    PsychometricParameters const p{std::log10(threshold), std::log10(std::exp(1.0)) / slope, 0.5, 0.02};
    for (double level = 2; level < 80; level *= 1.6)
        counts.push_back({level, 400 * proportion_at(weibull, p, level), 400});
    PsychometricSettings settings;
    settings.guess.value = 0.5;
    settings.lapse.value = 0.02;
    settings.shape = weibull;
    PsychometricFit const named = fit_psychometric(counts, settings);
    settings.shape.formula = std::make_shared<Formula const>(
        Formula::psychometric("guess + (1 - guess - lapse) * (1 - exp(-(x / threshold)^slope))"));
    PsychometricFit const written = fit_psychometric(counts, settings);
    EXPECT_NEAR(std::pow(10, written.parameters.threshold), threshold, 1e-3);
    EXPECT_NEAR(written.parameters.scale, slope, 1e-3);
    EXPECT_NEAR(written.deviance, named.deviance, 1e-6);
    EXPECT_NEAR(written.standard_error.threshold, named.standard_error.threshold, 1e-5);
    double const at = level_at(written.shape, written.parameters, 0.75);
    EXPECT_NEAR(at, level_at(named.shape, named.parameters, 0.75), 1e-3 * at);
    EXPECT_EQ(written.note, "");
    // Falling: larger levels are harder.
    settings.shape.direction = Direction::falling;
    settings.shape.formula = std::make_shared<Formula const>(
        Formula::psychometric("guess + (1 - guess - lapse) * (1 - exp(-(threshold / x)^slope))"));
    for (LevelCount& c : counts) {
        c.level = 1000 / c.level;
    }
    PsychometricFit const falling = fit_psychometric(counts, settings);
    EXPECT_NEAR(std::pow(10, -falling.parameters.threshold), 1000 / threshold, 0.1);
}

TEST(Formulas, GiveQuestPlusTheSameChoicesAsTheFunctionsThatTheyWrite)
{
    QuestSettings named;
    named.function = QuestFunction::weibull;
    for (double v = 1; v < 100; v *= 1.5) named.threshold.push_back(v);
    named.stimuli = named.threshold;
    named.slope = {1, 2, 4};
    QuestSettings written = named;
    written.function = QuestFunction::formula;
    written.formula = std::make_shared<Formula const>(
        Formula::psychometric("guess + (1 - guess - lapse) * (1 - exp(-(x / threshold)^slope))"));
    QuestPlus a(named), b(written);
    for (int i = 0; i < 30; ++i) {
        ASSERT_EQ(a.next(), b.next()) << i;
        bool const correct = i % 3 != 0;
        std::size_t const next = a.next();
        a.respond(next, correct);
        b.respond(next, correct);
    }
    written.formula = std::make_shared<Formula const>(Formula::psychometric("2 * x / threshold"));
    EXPECT_THROW(QuestPlus{written}, std::invalid_argument);
}

} // namespace
} // namespace study
