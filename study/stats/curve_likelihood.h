#pragma once
// The likelihood of one observer's answers at several levels under a psychometric function that is given by the
// level of a proportion correct instead of that of F = 1/2:  P(u) = guess + (1 - guess - lapse) F((u - threshold)
// / scale + offset), with the offset at which P(threshold) is the proportion. With overdispersion, answers of a
// level are beta-binomial: n answers have variance n p q (1 + (n - 1) / (nu + 1)), nu = 1 / eta^2 - 1.

#include "study/stats/psychometric_fit.h"

#include <optional>
#include <span>

namespace study {

struct LevelAnswers {
    double u = 0, right = 0, trials = 0;
};

struct LevelCurve {
    Sigmoid kind = Sigmoid::gaussian;
    double scale = 1, lapse = 0, guess = 0.5;
    double nu = 0; ///< infinite: binomial
    double offset = 0, offset_by_lapse = 0, offset_by_guess = 0;
};

/// None if the function does not reach the proportion. @param eta 0 = binomial
std::optional<LevelCurve> level_curve(Sigmoid kind, double proportion, double scale, double lapse, double guess,
                                      double eta);

/// Log-likelihood, without binomial coefficients, and its derivatives; information: Fisher's, of the threshold.
struct LevelLikelihood {
    double value = 0, by_threshold = 0, information = 0;
    double surprises = 0;                                           ///< sum over trials of p (1 - p)
    double by_log_scale = 0, by_lapse = 0, by_guess = 0, by_nu = 0; ///< 0 if not asked for
};
LevelLikelihood level_likelihood(std::span<LevelAnswers const> levels, LevelCurve const& curve, double threshold,
                                 bool with_curve);

/// d nu / d logit(eta), for the gradient.
double nu_by_logit(double eta);
inline constexpr double kLeastEta = 1e-3; ///< smaller ones are binomial within rounding

} // namespace study
