#pragma once
// Psychometric functions: the probability of a correct answer at a level (Wichmann & Hill 2001, Percept. Psychophys.
// 63:1293).
//   P(x) = guess + (1 - guess - lapse) F((u(x) - threshold) / scale),  u(x) = x or log10 x, or its negative.
// F: logistic 1/(1 + e^-z), Phi(z), Weibull's 1 - exp(-e^z), which on a logarithmic axis is 1 - exp(-(x/a)^b) with
// log10 a = threshold and b = log10(e) / scale and on a linear axis Gumbel's, the right-skewed Gumbel exp(-e^-z),
// the hyperbolic secant's 2/pi atan(e^(pi z/2)), Cauchy's 1/2 + atan(z)/pi; or a formula of P itself.

#include "study/adaptive/formula.h"

#include <memory>

namespace study {

enum class Sigmoid { logistic, gaussian, weibull, gumbel_right, hyperbolic_secant, cauchy };
enum class Axis { linear, log10 };
enum class Direction {
    rising, ///< larger levels are easier
    falling ///< larger levels are harder: u is negative, and so is the threshold; use level_at
};

struct PsychometricShape {
    Sigmoid sigmoid = Sigmoid::gaussian;
    Axis axis = Axis::linear;
    Direction direction = Direction::rising;
    /// If set, replaces F. It gives P as a function of the level, the threshold (a level),
    /// the slope (= scale), guess and lapse rates.
    std::shared_ptr<Formula const> formula{};
};

struct PsychometricParameters {
    double threshold = 0; ///< point at which F is 1/2 (Weibull: 1 - 1/e; right Gumbel: 1/e), in units of u
    double scale = 1;     ///< > 0, in units of u
    double guess = 0, lapse = 0;
};

double transformed(PsychometricShape const& shape, double level); ///< u(x)
/// P at a level.
double proportion_at(PsychometricShape const& shape, PsychometricParameters const& p, double level);
/// Level at which P has this value; NaN if P never reaches it, at or beyond guess and 1 - lapse.
double level_at(PsychometricShape const& shape, PsychometricParameters const& p, double proportion);

} // namespace study
