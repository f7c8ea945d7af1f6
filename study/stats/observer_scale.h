#pragma once
// Scores from pairs with errors over observers, whose trials are not independent.
//
// Variances are those of the sandwich estimator by observers (Huber 1967; Liang & Zeger 1986, Biometrika 73:13)
// with the correction of Kauermann & Carroll (2001, JASA 96:1387) for few observers, whose own choices pull the
// fit towards themselves. With d degrees of freedom (Fay & Graubard 2001, Biometrics 57:1198; here with the
// kurtosis of choices, which matters if nearly all agree) they are moderated by those of a model, with 2 degrees
// (as Smyth 2004, Stat. Appl. Genet. Mol. Biol. 3:3): V = (d V_observers + 2 V_model) / (d + 2). They are not more
// for more items, since these do not make the model truer of any one of them. Intervals are around scores with
// Jeffreys' prior, because those of maximum likelihood are too far apart on average.
//
// The sandwich takes scores as linear in choices. The jackknife does not: with changes by leaving out
// observers, times (1 - leverage)^(1/2), so that it equals the sandwich if all is linear, V_left_out is larger
// where far-off choices weigh more. Errors of trials alone need none of that, since V grows with the score
// (below); those of differences between observers do: V rises by (1 - (V_trials / V)^2) (V_left_out -
// V_observers), if above 0.
//
// Degrees of freedom of V are Satterthwaite's (1946, Biometrics Bull. 2:110): V is a quadratic form of observers'
// gradients, whose variance under the model follows from their covariances and the cumulants of choices. What V
// varies by together with the score, cov(V, score)^2 / var(score), does not count: towards unanimous choices
// errors grow with the score, and intervals grow where it is far out by chance. Of estimates from exponential
// families, which are skewed twice as much, this is right to the second order (statistics.md).
//
// In the model observer o has scores s + e_o with covariance C = a I + b s s^T: differences of single items, and a
// unit of his or her own, which stretches the scale and so moves its ends most. A gradient has then covariance
// I_o + I_o C I_o, with the information I_o of independent trials, and a and b follow from the score statistics of
// variance components, g^T C_k g (Lin 1997, Biometrika 84:309): sum over o of g^T C_k g - tr(I_o C_k) =
// sum over l of c_l tr(I_o C_k I_o C_l). They may come out below 0, so that they are not too large on average.

#include "study/stats/binomial.h"
#include "study/stats/pair_scale.h"

#include <array>
#include <span>

namespace study {

/// One possible answer to a pair: its probability, and the change of each score by one such answer, unit of F.
struct PairOutcome {
    double trials = 0, probability = 0;
    std::vector<double> influence;
};

/// One of the two components of how observers differ, as it enters variances of scores.
struct ScoreComponent {
    Matrix variance;                  ///< of the scores by one unit of the component
    Matrix with_squares;              ///< its covariance with the sum of observers' squares
    std::vector<double> with_score;   ///< its covariance with scores
    std::array<double, 2> covariance; ///< with both components
};

struct ObserverScale {
    PairScale fit;     ///< maximum likelihood of all trials
    PairScale reduced; ///< with Jeffreys' prior
    int observers = 0;
    /// Variance over observers by that of independent trials, mean over scores; at least 1/2.
    double dispersion = 1;
    /// By observer: change of each score by his or her choices, unit of F.
    std::vector<std::vector<double>> influence;
    std::vector<std::vector<double>> left_out; ///< the same by fits without his or her choices
    std::vector<Matrix> expected;              ///< by observer: covariance of that for independent trials
    Matrix modelled;                           ///< covariance of the scores by the model of how observers differ
    std::vector<Matrix> observer;              ///< by observer: its part of that, with no component below 0
    std::array<ScoreComponent, 2> components;
    std::vector<std::vector<PairOutcome>> outcomes; ///< by pair
};

/// Fits the pooled choices. @param observers  the pairs of each
/// @throws std::invalid_argument as fit_pairs; fewer than two observers
ObserverScale scale_observers(std::vector<std::vector<PairCount>> const& observers, int items,
                              PairSettings const& settings = {});

/// A weighted sum of scores, in the unit of F.
struct Contrast {
    double value = 0;              ///< by maximum likelihood
    double reduced = 0;            ///< with Jeffreys' prior: centre of the interval
    double standard_error = 0;     ///< over observers
    double degrees_of_freedom = 1; ///< of Student's distribution
    Interval interval;
    double p = 1; ///< of "the sum is 0"
};
/// @param weights  one per item
/// @throws std::invalid_argument another number of weights
Contrast contrast(ObserverScale const& scale, std::span<double const> weights, double confidence = 0.95);
/// One score, relative to the mean of all.
Contrast score_of(ObserverScale const& scale, int item, double confidence = 0.95);
Contrast difference_of(ObserverScale const& scale, int a, int b, double confidence = 0.95);

} // namespace study
