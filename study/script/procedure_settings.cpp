#include "study/script/procedure_settings.h"

#include <algorithm>

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
    bool const is_weibull = p.psychometric == Psychometric::weibull;
    s.function = is_weibull                               ? QuestFunction::weibull
                 : p.psychometric == Psychometric::normal ? QuestFunction::gaussian
                                                          : QuestFunction::logistic;
    s.direction = c.harder_up ? Direction::falling : Direction::rising;
    auto const on_axis = [&](std::vector<double> levels) {
        if (!is_weibull)
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

} // namespace study
