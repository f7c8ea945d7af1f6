#include "study/script/procedure.h"

#include "study/stats/staircase.h"

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
