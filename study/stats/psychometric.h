#pragma once
// Psychometric functions by maximum likelihood (Wichmann & Hill 2001, Percept. Psychophys. 63:1293):
//   P(x) = guess + (1 - guess - lapse) F((u(x) - threshold) / scale),  u(x) = x or log10 x, or its negative.
// F: logistic 1/(1 + e^-z), Phi(z), Weibull's 1 - exp(-e^z), which on a logarithmic axis is 1 - exp(-(x/a)^b) with
// log10 a = threshold and b = log10(e) / scale and on a linear axis Gumbel's, the right-skewed Gumbel exp(-e^-z),
// the hyperbolic secant's 2/pi atan(e^(pi z/2)), Cauchy's 1/2 + atan(z)/pi; or a formula of P itself.

#include "study/stats/binomial.h"
#include "study/stats/formula.h"
#include "study/stats/matrix.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

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

/// Trials at one level.
struct LevelCount {
    double level = 0;
    double correct = 0; ///< or "yes"
    double trials = 0;
};

/// A rate that is fixed, or fitted within [0, limit].
struct Rate {
    double value = 0;
    double limit = 0; ///< > 0 = fitted; `value` is then only the start value
};

struct PsychometricSettings {
    PsychometricShape shape;
    Rate guess, lapse;
};

struct PsychometricFit {
    PsychometricShape shape;
    PsychometricParameters parameters;
    PsychometricParameters standard_error; ///< 0 if fixed or at a bound; NaN if the data do not determine it
    Matrix covariance;                     ///< of threshold, log scale, guess, lapse
    double log_likelihood = 0;
    double deviance = 0; ///< against one free proportion per level
    int degrees_of_freedom = 0;
    double fit_p = 1; ///< P(deviance or larger) by chi-square, which is inaccurate for few trials per level
    bool converged = false;
    std::string note; ///< what the data could not determine; empty = nothing
};

double transformed(PsychometricShape const& shape, double level); ///< u(x)
/// P at a level.
double proportion_at(PsychometricShape const& shape, PsychometricParameters const& p, double level);
/// Level at which P has this value; NaN if P never reaches it, at or beyond guess and 1 - lapse.
double level_at(PsychometricShape const& shape, PsychometricParameters const& p, double proportion);

/// Standard error of u where P has this proportion, by the delta method; NaN as level_at.
double standard_error_at(PsychometricFit const& fit, double proportion);

/// Whether answers get better with u within observers (Mantel 1963, JASA 58:690). Between them they may not:
/// staircases of observers who err more stay at easier levels.
class Trend {
public:
    void add(double u, double n_correct, double n);
    void next_observer();
    bool is_falling() const; ///< by more than two standard errors

private:
    struct Sums { ///< over trials of an observer, u from his or her first level
        double first = 0, trials = 0, correct = 0, u = 0, square = 0, product = 0;
    };
    Sums own_;
    double covariance_ = 0, variance_ = 0; ///< of observers before
    void finish(double& covariance, double& variance) const;
};
inline constexpr char kWrongDirection[] =
    "responses change in the wrong direction: the other end of the levels may be the harder one (see `harder`)";

/// Ignores levels without trials and merges equal levels. @throws std::invalid_argument fewer than two levels,
/// invalid counts, levels that are NaN, levels <= 0 on a logarithmic axis, rates whose sum reaches 1
PsychometricFit fit_psychometric(std::span<LevelCount const> counts, PsychometricSettings const& settings = {});

/// Converts single trials to counts, sorted by level. @throws std::invalid_argument lists of different lengths
std::vector<LevelCount> count_levels(std::span<double const> levels, std::span<int const> correct);

} // namespace study
