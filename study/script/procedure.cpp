#include "study/script/procedure.h"

#include "study/adaptive/staircase.h"

#include <algorithm>
#include <cmath>

namespace study {

double to_scale(Scale scale, double level)
{
    switch (scale) {
    case Scale::log2:
        return std::log2(level);
    case Scale::log10:
        return std::log10(level);
    case Scale::db:
        return 20 * std::log10(level);
    default:
        return level;
    }
}

double from_scale(Scale scale, double value)
{
    switch (scale) {
    case Scale::log2:
        return std::exp2(value);
    case Scale::log10:
        return std::pow(10, value);
    case Scale::db:
        return std::pow(10, value / 20);
    default:
        return value;
    }
}

std::string_view name_of(Scale scale)
{
    constexpr std::string_view kNames[] = {"linear", "log2", "log10", "db"};
    return kNames[std::size_t(scale)];
}

std::optional<Scale> scale_of(std::string_view name)
{
    for (Scale const s : {Scale::linear, Scale::log2, Scale::log10, Scale::db})
        if (name_of(s) == name) return s;
    return {};
}

std::optional<Method> method_of(std::string_view name)
{
    for (Method const m : {Method::constant, Method::staircase, Method::questplus, Method::adjustment})
        if (name_of(m) == name) return m;
    return {};
}

std::string_view name_of(Method method)
{
    constexpr std::string_view kNames[] = {"constant", "staircase", "questplus", "adjustment"};
    return kNames[std::size_t(method)];
}

std::vector<std::string> psychometric_names()
{
    return {"weibull", "normal", "logistic", "gumbel", "gumbel_right", "hyperbolic_secant", "cauchy"};
}

std::string PsychometricChoice::name() const
{
    return function == Psychometric::formula ? formula->text() : psychometric_names()[std::size_t(function)];
}

PsychometricChoice assumed_function(Procedure const& p)
{
    return p.psychometric.value_or(PsychometricChoice{Psychometric::weibull, {}});
}

PsychometricChoice fitted_function(std::vector<Procedure> const& procedures, Scale scale)
{
    PsychometricChoice const usual{scale == Scale::linear ? Psychometric::normal : Psychometric::weibull, {}};
    if (procedures.empty() || !procedures[0].psychometric) return usual;
    bool const agree = std::all_of(procedures.begin(), procedures.end(), [&](Procedure const& p) {
        return p.psychometric && *p.psychometric == *procedures[0].psychometric;
    });
    return agree ? *procedures[0].psychometric : usual;
}

bool Procedure::has_one_point() const
{
    auto const is_one = [](QuestGrid const& g) { return g.values.size() == 1; };
    return threshold.size() == 1 && slope.size() == 1 && guess.size() == 1 && lapse.size() == 1 &&
           std::all_of(parameters.begin(), parameters.end(), is_one);
}

bool is_adaptive(Procedure const& procedure)
{
    return procedure.method == Method::staircase || procedure.method == Method::questplus;
}

int planned_trials(Procedure const& p)
{
    return is_adaptive(p) ? p.stop.trials : int(p.levels.size()) * p.trials_per_level;
}

double settles_at(Procedure const& s)
{
    if (s.target) return *s.target;
    StaircaseSettings rule;
    rule.up = s.up;
    rule.down = s.down;
    return staircase_target(rule);
}

} // namespace study
