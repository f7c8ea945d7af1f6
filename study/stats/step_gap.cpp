#include "study/stats/step_gap.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <vector>

namespace study {
namespace {

/// Answers of a level, or of neighbouring levels.
struct Answers {
    double correct = 0, trials = 0;

    double share() const { return correct / trials; }
    Answers operator+(Answers const& other) const { return {correct + other.correct, trials + other.trials}; }
    double log_likelihood(double p) const
    {
        double sum = 0;
        if (correct > 0) sum += correct * std::log(p);
        if (trials > correct) sum += (trials - correct) * std::log1p(-p);
        return sum;
    }
};

/// The largest log-likelihood of a rising function with values from `low` to `high`: pools adjacent violators (Ayer et
/// al. 1955, Ann. Math. Stat. 26:641).
double rising_log_likelihood(std::vector<Answers> const& levels, double low, double high)
{
    std::vector<Answers> pools;
    for (Answers const& a : levels) {
        pools.push_back(a);
        while (pools.size() > 1 && pools[pools.size() - 2].share() > pools.back().share()) {
            Answers const both = pools[pools.size() - 2] + pools.back();
            pools.pop_back();
            pools.back() = both;
        }
    }
    double sum = 0;
    for (Answers const& a : pools) sum += a.log_likelihood(std::clamp(a.share(), low, high));
    return sum;
}

} // namespace

std::optional<StepGap> step_gap(std::span<LevelCount const> counts, PsychometricShape const& shape,
                                StepRates const& rates)
{
    constexpr double kMostGuess = 0.5, kMostLapse = 0.06, kAlike = 0.25;
    std::map<double, std::pair<double, Answers>> by_u; // u -> level and answers
    for (LevelCount const& c : counts) {
        if (!(c.trials > 0)) continue;
        auto& [level, answers] = by_u[transformed(shape, c.level)];
        level = c.level;
        answers = answers + Answers{c.correct, c.trials};
    }
    std::vector<double> levels;
    std::vector<Answers> answers;
    for (auto const& [unused, at] : by_u) {
        levels.push_back(at.first);
        answers.push_back(at.second);
    }
    double const most = rising_log_likelihood(answers, rates.guess.value_or(0), 1 - rates.lapse.value_or(0));
    std::optional<StepGap> gap;
    for (std::size_t k = 1; k < answers.size(); ++k) {
        Answers below, above;
        for (std::size_t i = 0; i < answers.size(); ++i)
            (i < k ? below : above) = (i < k ? below : above) + answers[i];
        double const floor = rates.guess.value_or(std::min(below.share(), kMostGuess));
        double const ceiling = rates.lapse ? 1 - *rates.lapse : std::max(above.share(), 1 - kMostLapse);
        double const step = below.log_likelihood(floor) + above.log_likelihood(ceiling);
        if (!(floor < ceiling && most - step <= kAlike)) continue;
        double const low = std::min(levels[k - 1], levels[k]), high = std::max(levels[k - 1], levels[k]);
        gap = gap ? StepGap{std::min(gap->low, low), std::max(gap->high, high)} : StepGap{low, high};
    }
    return gap;
}

void include_gap(StepGap const& gap, PsychometricShape const& shape, Interval& interval)
{
    for (double const level : {gap.low, gap.high}) {
        double const u = transformed(shape, level);
        interval = {std::min(interval.low, u), std::max(interval.high, u)};
    }
}

std::string text_of(StepGap const& gap)
{
    return fmt::format(
        "any threshold between {:.9g} and {:.9g} fits these answers equally well, which change from guessing "
        "to knowing between them",
        gap.low, gap.high);
}

} // namespace study
