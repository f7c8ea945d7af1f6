#include "study/stats/psychometric.h"

#include "study/stats/error.h"
#include "study/stats/root.h"
#include "study/stats/sigmoid.h"
#include "study/stats/special.h"

#include <array>
#include <cmath>
#include <map>

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

double standard_error_at(PsychometricFit const& fit, double proportion)
{
    auto const moved = [&](std::size_t i, double by) {
        PsychometricParameters p = fit.parameters;
        if (i == 0) p.threshold += by;
        if (i == 1) p.scale *= std::exp(by);
        if (i == 2) p.guess += by;
        if (i == 3) p.lapse += by;
        return transformed(fit.shape, level_at(fit.shape, p, proportion));
    };
    std::array<double, 4> slope{};
    for (std::size_t i = 0; i < 4; ++i) {
        if (fit.covariance(i, i) == 0) continue;
        double const step = 1e-3 * std::sqrt(fit.covariance(i, i));
        slope[i] = (moved(i, step) - moved(i, -step)) / (2 * step);
    }
    double variance = 0;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) variance += slope[i] * fit.covariance(i, j) * slope[j];
    return std::sqrt(variance);
}

void Trend::add(double u, double n_correct, double n)
{
    if (own_.trials == 0) own_.first = u;
    double const away = u - own_.first; // 0 if there is one level, whatever is rounded
    own_.trials += n;
    own_.correct += n_correct;
    own_.u += n * away;
    own_.square += n * away * away;
    own_.product += n_correct * away;
}

void Trend::next_observer()
{
    finish(covariance_, variance_);
    own_ = {};
}

void Trend::finish(double& covariance, double& variance) const
{
    if (own_.trials == 0) return;
    double const p = own_.correct / own_.trials;
    covariance += own_.product - p * own_.u;
    variance += p * (1 - p) * std::max(0.0, own_.square - own_.u * own_.u / own_.trials);
}

bool Trend::is_falling() const
{
    double covariance = covariance_, variance = variance_;
    finish(covariance, variance);
    return covariance < -2 * std::sqrt(variance);
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
