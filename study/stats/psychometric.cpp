#include "study/stats/psychometric.h"

#include "study/stats/error.h"
#include "study/stats/sigmoid.h"
#include "study/stats/special.h"

#include <cmath>
#include <map>

namespace study {

double transformed(PsychometricShape const& shape, double level)
{
    double const u = shape.axis == Axis::log10 ? std::log10(level) : level;
    return shape.direction == Direction::rising ? u : -u;
}

double proportion_at(PsychometricShape const& shape, PsychometricParameters const& p, double level)
{
    double const z = (transformed(shape, level) - p.threshold) / p.scale;
    return p.guess + (1 - p.guess - p.lapse) * sigmoid(shape.sigmoid, z).below;
}

double level_at(PsychometricShape const& shape, PsychometricParameters const& p, double proportion)
{
    double const f = (proportion - p.guess) / (1 - p.guess - p.lapse);
    if (!(f > 0 && f < 1)) return std::nan("");
    double u = p.threshold + p.scale * sigmoid_quantile(shape.sigmoid, f);
    if (shape.direction == Direction::falling) u = -u;
    return shape.axis == Axis::log10 ? std::pow(10, u) : u;
}

std::vector<LevelCount> count_levels(std::span<double const> levels, std::span<int const> correct)
{
    if (levels.size() != correct.size())
        refuse(std::to_string(levels.size()) + " levels and " + std::to_string(correct.size()) + " responses",
               "each trial has one of both", "give lists of the same length");
    std::map<double, LevelCount> counts;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (std::isnan(levels[i]))
            refuse("a level that is not a number", "it has no place on the axis", "leave it out");
        LevelCount& c = counts[levels[i]];
        c.level = levels[i];
        c.correct += correct[i] != 0;
        c.trials += 1;
    }
    std::vector<LevelCount> result;
    for (auto const& [unused, c] : counts) result.push_back(c);
    return result;
}

} // namespace study
