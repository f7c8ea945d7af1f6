#include "study/stats/own_threshold.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/threshold_marginal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace study {
namespace {

constexpr double kLeastInformation = 1e-200; // below it only the likelihood counts
constexpr int kThresholdSteps = 600;         // over three ranges

double place_of(int step) { return -1.5 + 3.0 * step / kThresholdSteps; }

/// Fisher information of one trial at a level, about the threshold.
double information_at(LevelCurve const& curve, double level, double threshold)
{
    LevelAnswers const one{level, 0, 1};
    return level_likelihood(std::span(&one, 1), curve, threshold, false).information;
}

/// From the threshold to the level at which a trial informs most.
double best_distance(LevelCurve const& curve)
{
    double best = 0, most = -1;
    for (double d = -5; d <= 5; d += 0.05) {
        double const here = information_at(curve, d * curve.scale, 0);
        if (here <= most) continue;
        most = here;
        best = d * curve.scale;
    }
    return best;
}

/// Adds the logarithm of likelihood, prior and weight at every place.
std::vector<double> log_density(std::vector<LevelAnswers> const& levels, LevelCurve const& curve, bool is_fixed,
                                double weight)
{
    double const best = is_fixed ? 0 : best_distance(curve);
    std::vector<double> density;
    for (int i = 0; i <= kThresholdSteps; ++i) {
        double const t = place_of(i);
        LevelLikelihood const l = level_likelihood(levels, curve, t, false);
        double const information =
            is_fixed ? l.information : information_at(curve, std::clamp(t + best, -0.5, 0.5), t);
        density.push_back(l.value + 0.5 * std::log(std::max(information, kLeastInformation)) + std::log(weight));
    }
    return density;
}

} // namespace

PosteriorLevel own_threshold(ObserverLevels const& observer, GroupThreshold const& group,
                             GroupThresholdSettings const& settings)
{
    ThresholdMarginal const checked(std::span(&observer, 1), settings);
    double const range = checked.range(), guess = settings.fits_guess ? group.shared.guess : observer.guess;
    double const error =
        group.scale_error * std::sqrt(group.observers / std::max(1.0, double(group.observers - 1)));
    std::vector<double> density(kThresholdSteps + 1, -kInfinity);
    double most = -kInfinity;
    for (int const side : {-1, 0, 1}) { // Gauss-Hermite quadrature over the scale
        if (side != 0 && error == 0) continue;
        double const scale = group.shared.scale / range * std::exp(side * std::numbers::sqrt3 * error);
        auto const curve = level_curve(settings.shape.sigmoid, settings.proportion, scale, group.shared.lapse,
                                       guess, checked.is_repeated() ? group.eta : 0);
        if (!curve)
            refuse("a threshold at " + std::to_string(settings.proportion) + " right answers",
                   "this observer's function starts above it or ends below it", "choose another proportion");
        auto const part =
            log_density(checked.people()[0].levels, *curve, group.are_levels_fixed, side == 0 ? 4.0 / 6 : 1.0 / 6);
        for (std::size_t i = 0; i < density.size(); ++i) {
            double const high = std::max(density[i], part[i]), low = std::min(density[i], part[i]);
            density[i] = std::isinf(high) ? high : high + std::log1p(std::exp(low - high));
            most = std::max(most, density[i]);
        }
    }
    double sum = 0, first = 0, second = 0;
    for (int i = 0; i <= kThresholdSteps; ++i) {
        double& here = density[std::size_t(i)];
        here = std::exp(here - most);
        sum += here;
        first += here * place_of(i);
        second += here * place_of(i) * place_of(i);
    }
    auto const quantile = [&](double p) {
        double below = 0;
        for (int i = 0; i <= kThresholdSteps; ++i) {
            double const here = density[std::size_t(i)] / sum;
            if (below + here >= p) return place_of(i) + ((p - below) / here - 0.5) * 3.0 / kThresholdSteps;
            below += here;
        }
        return place_of(kThresholdSteps);
    };
    auto const on_u = [&](double x) { return checked.centre() + range * x; };
    double const tail = (1 - settings.confidence) / 2, mean = first / sum;
    return {on_u(quantile(0.5)), range * std::sqrt(std::max(0.0, second / sum - mean * mean)),
            on_u(quantile(tail)), on_u(quantile(1 - tail)), 0};
}

} // namespace study
