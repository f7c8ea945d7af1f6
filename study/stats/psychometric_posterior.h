#pragma once
// What the trials of one observer say of a psychometric function, as a distribution over functions: threshold,
// scale, lapse rate, where needed guess rate and overdispersion, with weak priors. Estimates are medians of that
// distribution, intervals its equal tails, which include what is not known of slope and lapses. After psignifit
// (Schütt, Harmeling, Macke & Wichmann 2016, Vision Res. 122:105), whose priors these follow, and which integrates
// over a grid; here points of a Halton sequence are weighted that follow Student's distribution around the mode
// (importance sampling, adapted once).
//
// Priors: threshold even within the range, falling beyond it like a normal distribution of a quarter of its width;
// log scale normal, centred at an eighth of the range, standard deviation 1; lapse rate and overdispersion eta
// Beta(1, 10); guess rate, where fitted, Beta(1, 1), to which trials without a signal are added. Overdispersion:
// answers of a level are beta-binomial, with variance n p q (1 + (n - 1) eta^2): thresholds that drift.

#include "study/stats/psychometric_fit.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace study {

struct PosteriorSettings {
    PsychometricShape shape;
    double guess = 0.5;            ///< if not fitted
    std::optional<double> lapse{}; ///< fixed; none = it is fitted
    bool fits_guess = false; ///< from all trials, and from `false_alarms` of `noises` trials without a signal
    double false_alarms = 0, noises = 0;
    double low = 0, high = 1; ///< levels between which the threshold is expected, both ends of the range on offer
    bool is_overdispersed = true; ///< levels with two or more trials have a common eta, which is fitted
};

/// A possible function, and its probability.
struct PossibleFunction {
    PsychometricParameters parameters;
    double eta = 0;
    double weight = 0; ///< sums to 1
};

struct PsychometricPosterior {
    PsychometricShape shape;
    std::vector<PossibleFunction> functions;
    PsychometricParameters mean; ///< scale: the geometric mean
    double eta = 0;              ///< mean
    double effective = 0;        ///< number of points that count, of functions.size()
};

/// A level, in units of u (see transformed).
struct PosteriorLevel {
    double centre = 0; ///< the median
    double deviation = 0, low = 0, high = 0;
    double never = 0; ///< probability that the function never reaches the proportion; ends may then be infinite
};

/// One level is enough, as are data that are all right or all wrong: the priors then give wide intervals.
/// @throws std::invalid_argument no trials, invalid counts, levels or rates, a range without width, or
/// no function that fits (a guess rate of nearly 1)
PsychometricPosterior psychometric_posterior(std::span<LevelCount const> counts,
                                             PosteriorSettings const& settings);

/// Where P reaches the proportion. NaN if more than half of the functions never do.
PosteriorLevel posterior_level(PsychometricPosterior const& posterior, double proportion,
                               double confidence = 0.95);

} // namespace study
