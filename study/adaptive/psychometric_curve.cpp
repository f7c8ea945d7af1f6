#include "study/adaptive/psychometric_curve.h"

#include "study/adaptive/sigmoid.h"
#include "study/numeric/root.h"

#include <array>
#include <cmath>

namespace study {

double transformed(PsychometricShape const& shape, double level)
{
    double const u = shape.axis == Axis::log10 ? std::log10(level) : level;
    return shape.direction == Direction::rising ? u : -u;
}

namespace {

double level_of(PsychometricShape const& shape, double u)
{
    if (shape.direction == Direction::falling) u = -u;
    return shape.axis == Axis::log10 ? std::pow(10, u) : u;
}

/// Where the formula crosses the proportion, searched outwards from the threshold; NaN if nowhere.
double crossing(PsychometricShape const& shape, PsychometricParameters const& p, double proportion)
{
    auto const above = [&](double u) { return proportion_at(shape, p, level_of(shape, u)) - proportion; };
    double const farthest = shape.axis == Axis::log10 ? 12 : 1e6 * std::max(1.0, std::abs(p.threshold));
    for (double step = 1e-3; step < farthest; step *= 2)
        for (double const sign : {-1.0, 1.0}) {
            double const a = p.threshold + sign * (step == 1e-3 ? 0 : step / 2), b = p.threshold + sign * step;
            double const at_a = above(a), at_b = above(b);
            if (!(at_a * at_b <= 0)) continue;
            double const way = at_a <= 0 ? 1 : -1;
            return bisect([&](double u) { return way * above(u); }, a, b);
        }
    return std::nan("");
}

} // namespace

double proportion_at(PsychometricShape const& shape, PsychometricParameters const& p, double level)
{
    if (shape.formula)
        return (*shape.formula)(std::array{level, level_of(shape, p.threshold), p.scale, p.guess, p.lapse});
    double const z = (transformed(shape, level) - p.threshold) / p.scale;
    return p.guess + (1 - p.guess - p.lapse) * sigmoid(shape.sigmoid, z).below;
}

double level_at(PsychometricShape const& shape, PsychometricParameters const& p, double proportion)
{
    double const f = (proportion - p.guess) / (1 - p.guess - p.lapse);
    if (!(f > 0 && f < 1)) return std::nan("");
    if (shape.formula) return level_of(shape, crossing(shape, p, proportion));
    return level_of(shape, p.threshold + p.scale * sigmoid_quantile(shape.sigmoid, f));
}

} // namespace study
