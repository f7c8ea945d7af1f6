#pragma once
// Psychometric functions by maximum likelihood (Wichmann & Hill 2001, Percept. Psychophys. 63:1293):
//   P(x) = guess + (1 - guess - lapse) F((u(x) - threshold) / scale),  u(x) = x or log10 x, or minus that.
// F: logistic 1/(1 + e^-z), Phi(z), or Weibull's 1 - exp(-e^z), which on a logarithmic axis is
// 1 - exp(-(x/a)^b) with log10 a = threshold and b = log10(e) / scale.

#include "study/stats/binomial.h"
#include "study/stats/matrix.h"

#include <cstdint>
#include <string>

namespace study {

enum class Sigmoid { logistic, gaussian, weibull };
enum class Axis { linear, log10 };
enum class Direction {
    rising, ///< larger levels are easier
    falling ///< larger levels are harder: u is negative, and so is the threshold; use level_at
};

struct PsychometricShape {
    Sigmoid sigmoid = Sigmoid::gaussian;
    Axis axis = Axis::linear;
    Direction direction = Direction::rising;
};

struct PsychometricParameters {
    double threshold = 0; ///< where F is 1/2 (Weibull: 1 - 1/e), in units of u
    double scale = 1;     ///< > 0, in units of u
    double guess = 0, lapse = 0;
};

/// Trials at one level.
struct LevelCount {
    double level = 0;
    double correct = 0; ///< or "yes"
    double trials = 0;
};

/// A rate that is known, or fitted within [0, limit].
struct Rate {
    double value = 0;
    double limit = 0; ///< > 0 = fitted; `value` is then only the start
};

struct PsychometricSettings {
    PsychometricShape shape;
    Rate guess, lapse;
};

struct PsychometricFit {
    PsychometricShape shape;
    PsychometricParameters parameters;
    PsychometricParameters standard_error; ///< 0 where known or at a bound; NaN where the data do not say
    Matrix covariance;                     ///< of threshold, log scale, guess, lapse
    double log_likelihood = 0;
    double deviance = 0; ///< against one free proportion per level
    int degrees_of_freedom = 0;
    double fit_p = 1; ///< P(deviance or more) by chi-square, which is rough where trials per level are few
    bool converged = false;
    std::string note; ///< what the data could not settle; empty = nothing
};

double transformed(PsychometricShape const& shape, double level); ///< u(x)
/// P at a level.
double proportion_at(PsychometricShape const& shape, PsychometricParameters const& p, double level);
/// The level where P has that value; NaN where it never has, at or beyond guess and 1 - lapse.
double level_at(PsychometricShape const& shape, PsychometricParameters const& p, double proportion);

/// Levels without trials are left out, equal levels are one. @throws std::invalid_argument fewer than two levels,
/// counts that are none, levels that are no numbers, on a logarithmic axis levels <= 0, rates whose sum reaches 1
PsychometricFit fit_psychometric(std::span<LevelCount const> counts, PsychometricSettings const& settings = {});

/// Single trials as counts, levels rising. @throws std::invalid_argument lists of different lengths
std::vector<LevelCount> count_levels(std::span<double const> levels, std::span<int const> correct);

} // namespace study
