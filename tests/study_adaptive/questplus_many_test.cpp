// QUEST+ of several dimensions: the one-dimensional one again, and a contrast sensitivity function.

#include "study/adaptive/questplus.h"
#include "study/adaptive/questplus_many.h"
#include "study/numeric/random.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study {
namespace {

std::shared_ptr<Formula const> formula_of(std::string const& text, QuestManySettings const& s)
{
    return std::make_shared<Formula const>(text, names_of(s.stimulus, s.parameters), s.stimulus.size());
}

TEST(QuestPlusMany, OfOneDimensionChoosesAsQuestPlus)
{
    QuestSettings one;
    for (double v = 1; v < 100; v *= 1.5) one.threshold.push_back(v);
    one.stimuli = one.threshold;
    one.function = QuestFunction::weibull;
    one.slope = {1, 2, 4};
    one.lapse = {0.01, 0.05};
    QuestManySettings many;
    many.stimulus = {{"x", one.stimuli}};
    many.parameters = {
        {"threshold", one.threshold}, {"slope", one.slope}, {"guess", one.guess}, {"lapse", one.lapse}};
    many.formula = formula_of("guess + (1 - guess - lapse) * (1 - exp(-(x / threshold)^slope))", many);
    QuestPlus a(one);
    QuestPlusMany b(many);
    for (int i = 0; i < 40; ++i) {
        ASSERT_EQ(a.next(), b.next()) << i;
        bool const correct = i % 4 != 1;
        b.respond(b.next(), correct);
        a.respond(a.next(), correct);
        ASSERT_NEAR(a.entropy(), b.entropy(), 1e-9);
    }
    EXPECT_NEAR(a.mean().threshold, b.mean()[0], 1e-9);
    EXPECT_NEAR(a.standard_deviation().slope, b.standard_deviation()[1], 1e-9);
    EXPECT_EQ(a.mode().lapse, b.mode()[3]);
}

QuestManySettings contrast_sensitivity()
{
    QuestManySettings s;
    QuestGrid contrast{"x", {}}, frequency{"f", {0.5, 1, 2, 4, 8, 16}};
    for (int i = 0; i <= 20; ++i) contrast.values.push_back(std::pow(10, -2 + 0.1 * i));
    s.stimulus = {contrast, frequency};
    s.parameters = {
        {"best", {0.02, 0.03, 0.045, 0.07, 0.1}}, {"peak", {1, 2, 4}}, {"width", {1, 1.5, 2}}, {"lapse", {0.02}}};
    s.formula =
        formula_of("0.5 + (0.5 - lapse) * (1 - exp(-(x / (best * 2 ^ ((log2(f / peak) / width) ^ 2)))^3))", s);
    return s;
}

TEST(QuestPlusMany, FindsAContrastSensitivityFunctionAgain)
{
    QuestManySettings const s = contrast_sensitivity();
    int right_peak = 0;
    double away = 0;
    constexpr int kRuns = 12;
    for (int run = 0; run < kRuns; ++run) {
        Random random = Random::part(5, std::uint64_t(run));
        QuestPlusMany quest(s);
        double const before = quest.entropy();
        for (int i = 0; i < 150; ++i) {
            std::size_t const next = quest.next();
            auto const x = quest.stimulus(next);
            ASSERT_EQ(quest.index_of(x), next);
            double const p = (*s.formula)(std::array{x[0], x[1], 0.045, 2.0, 1.5, 0.02});
            quest.respond(next, random.uniform() < p);
        }
        EXPECT_LT(quest.entropy(), before - 2);
        right_peak += quest.mode()[1] == 2.0;
        away += std::abs(std::log(quest.mean()[0] / 0.045)) / kRuns;
    }
    EXPECT_GE(right_peak, 9) << "of 12";
    EXPECT_LT(away, 0.25);
}

TEST(QuestPlusMany, RefusesWhatItCannotCompute)
{
    QuestManySettings s = contrast_sensitivity();
    s.formula = formula_of("x / best * f", s);
    EXPECT_THROW(QuestPlusMany{s}, std::invalid_argument) << "more than 1";
    s = contrast_sensitivity();
    s.parameters[0].values.clear();
    EXPECT_THROW(QuestPlusMany{s}, std::invalid_argument);
    s = contrast_sensitivity();
    s.parameters.pop_back(); // the formula takes it
    EXPECT_THROW(QuestPlusMany{s}, std::invalid_argument);
}

} // namespace
} // namespace study
