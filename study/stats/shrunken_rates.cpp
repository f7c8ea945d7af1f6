#include "study/stats/shrunken_rates.h"

#include "study/numeric/error.h"

#include <algorithm>

namespace study {

std::vector<double> shrunken_rates(std::span<RateCount const> observers)
{
    double yes = 0, trials = 0;
    for (RateCount const& o : observers) {
        if (!(o.yes >= 0 && o.yes <= o.trials))
            refuse("a rate of more answers than trials", "it is a proportion", "count them again");
        yes += o.yes;
        trials += o.trials;
    }
    if (!(trials > 0)) refuse("a rate without trials", "nothing was answered", "leave the condition out");
    double const mean = (yes + 0.5) / (trials + 1);
    // The squared differences by those of chance, and how they grow with
    // the correlation of one observer's answers.
    double found = 0, chance = 0, growth = 0;
    for (RateCount const& o : observers) {
        if (!(o.trials > 0)) continue;
        double const away = o.yes / o.trials - yes / trials, others = 1 - o.trials / trials;
        found += o.trials * away * away / (mean * (1 - mean));
        chance += others;
        growth += others * (o.trials - 1);
    }
    double const correlation = growth > 0 ? std::clamp((found - chance) / growth, 0.0, 1.0) : 1;
    std::vector<double> rates;
    for (RateCount const& o : observers) {
        // (yes + mean k) / (trials + k), k = 1 / correlation - 1, without infinite k.
        double const own = correlation * o.trials, rest = 1 - correlation;
        rates.push_back((correlation * (o.yes + 0.5) + rest * mean) / (own + rest + correlation));
    }
    return rates;
}

} // namespace study
