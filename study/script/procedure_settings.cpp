#include "study/script/procedure_settings.h"

#include "gi/core/text.h"
#include "study/numeric/root.h"
#include "study/script/condition.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace study {

double harder_sign(Compare const& c) { return c.harder_up ? -1 : 1; }

StaircaseSettings staircase_settings(Procedure const& p, Compare const& c)
{
    double const sign = harder_sign(c), low = sign * to_scale(c.scale, c.low),
                 high = sign * to_scale(c.scale, c.high);
    StaircaseSettings s;
    s.start = sign * to_scale(c.scale, p.start);
    s.steps = p.steps;
    s.up = p.up;
    s.down = p.down;
    if (p.target) {
        s.up = s.down = 1;
        s.up_ratio = *p.target / (1 - *p.target);
    }
    s.initial = InitialRule::none;
    s.low = std::min(low, high);
    s.high = std::max(low, high);
    s.stop = {p.stop.reversals, 0, p.stop.trials};
    return s;
}

QuestSettings quest_settings(Procedure const& p, Compare const& c)
{
    QuestSettings s;
    PsychometricChoice const function = assumed_function(p);
    s.function = quest_function(function.function);
    s.formula = function.formula;
    s.direction = c.harder_up ? Direction::falling : Direction::rising;
    auto const on_axis = [&](std::vector<double> levels) {
        if (!function.takes_levels())
            for (double& v : levels) v = to_scale(c.scale, v);
        return levels;
    };
    s.stimuli = on_axis(p.stimuli);
    s.threshold = on_axis(p.threshold);
    s.slope = p.slope;
    s.guess = p.guess;
    s.lapse = p.lapse;
    return s;
}

QuestManySettings quest_many_settings(Procedure const& p)
{
    QuestManySettings s;
    s.stimulus = {{"x", p.stimuli}};
    s.stimulus.insert(s.stimulus.end(), p.also.begin(), p.also.end());
    s.parameters = {{"threshold", p.threshold}, {"slope", p.slope}, {"guess", p.guess}, {"lapse", p.lapse}};
    s.parameters.insert(s.parameters.end(), p.parameters.begin(), p.parameters.end());
    s.formula = p.psychometric ? p.psychometric->formula : nullptr;
    return s;
}

std::string further_text(Compare const& c, std::vector<double> const& levels)
{
    std::string text;
    for (std::size_t i = 0; i < levels.size(); ++i)
        text += (i > 0 ? " " : "") + c.also[i].setting + "=" + level_text(levels[i]);
    return text;
}

std::vector<double> further_of_text(Compare const& c, std::string const& text)
{
    std::vector<double> levels;
    std::istringstream in(text);
    std::string word;
    for (FurtherSetting const& f : c.also) {
        if (!(in >> word) || !word.starts_with(f.setting + "=")) return {};
        auto const level = gi::parse_finite(std::string_view(word).substr(f.setting.size() + 1));
        if (!level) return {};
        levels.push_back(*level);
    }
    return levels;
}

QuestFunction quest_function(Psychometric function)
{
    constexpr QuestFunction kFunctions[]{QuestFunction::weibull,      QuestFunction::gaussian,
                                         QuestFunction::logistic,     QuestFunction::gumbel,
                                         QuestFunction::gumbel_right, QuestFunction::hyperbolic_secant,
                                         QuestFunction::cauchy,       QuestFunction::formula};
    return kFunctions[std::size_t(function)];
}

PsychometricShape shape_of(Scale scale, bool harder_up, PsychometricChoice const& function)
{
    // On a linear axis the curve of weibull is that of gumbel: fits take it of the axis, not of levels.
    constexpr Sigmoid kSigmoids[]{Sigmoid::weibull, Sigmoid::gaussian,     Sigmoid::logistic,
                                  Sigmoid::weibull, Sigmoid::gumbel_right, Sigmoid::hyperbolic_secant,
                                  Sigmoid::cauchy,  Sigmoid::gaussian};
    PsychometricShape s;
    s.sigmoid = kSigmoids[std::size_t(function.function)];
    s.axis = scale == Scale::linear ? Axis::linear : Axis::log10;
    s.direction = harder_up ? Direction::falling : Direction::rising;
    s.formula = function.formula;
    return s;
}

double proportion_correct(PsychometricChoice const& function, Scale scale, bool harder_up, QuestParameters p,
                          double level)
{
    QuestSettings s;
    s.function = quest_function(function.function);
    s.formula = function.formula;
    s.direction = harder_up ? Direction::falling : Direction::rising;
    if (function.takes_levels()) return proportion_by(s, p, level);
    p.threshold = to_scale(scale, p.threshold);
    return proportion_by(s, p, to_scale(scale, level));
}

double level_of_proportion(PsychometricChoice const& function, Scale scale, bool harder_up,
                           QuestParameters const& p, double proportion)
{
    double const middle = to_scale(scale, p.threshold);
    double const far = scale == Scale::linear ? 1000 * p.slope + 1000 * std::abs(middle) : to_scale(scale, 1000);
    auto const above = [&](double u) {
        return proportion_correct(function, scale, harder_up, p, from_scale(scale, u)) - proportion;
    };
    double a = middle - far, b = middle + far;
    // Functions of levels have none below 0 on a linear scale.
    if (scale == Scale::linear && function.takes_levels()) a = std::max(a, 1e-6 * std::abs(middle));
    double const at_a = above(a);
    if (!(at_a * above(b) < 0)) return std::nan("");
    double const sign = at_a < 0 ? 1 : -1;
    return from_scale(scale, bisect([&](double u) { return sign * above(u); }, a, b));
}

} // namespace study
