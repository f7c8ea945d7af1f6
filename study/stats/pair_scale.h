#pragma once
// Scores from paired comparisons by maximum likelihood:
//   P(first is chosen) = F(s_first - s_second + b),
// Thurstone's case V (1927, Psychol. Rev. 34:273) with F = Phi, Bradley & Terry's model (1952, Biometrika 39:324)
// with F = the logistic function; b is the order effect (left or first is preferred; as in Agresti 1990, p. 438).
// Ties count half for each item, or have a threshold t: P(first) = F(d + b - t), P(second) = F(-d - b - t)
// (Glenn & David 1960, Biometrics 16:86, for Phi; Rao & Kupper 1967, JASA 62:194, for the logistic function).
// Scores are in the unit of F, with mean 0; in JOD a difference of 1 means that 75 % choose the better one.

#include "study/stats/pairs.h"

#include <optional>
#include <span>

namespace study {

enum class PairModel { thurstone_v, bradley_terry };
enum class OrderEffect { none, fitted };
enum class TieModel { half_wins, threshold };
enum class Regularisation {
    never,       ///< refuses data whose estimates would be infinite
    when_needed, ///< Jeffreys' prior (likelihood.h) if estimates would be infinite; `note` reports it
    always       ///< Jeffreys' prior: also removes small-sample bias
};

struct PairSettings {
    PairModel model = PairModel::thurstone_v;
    OrderEffect order = OrderEffect::none;
    TieModel ties = TieModel::half_wins;
    Regularisation regularisation = Regularisation::when_needed;
};

struct Estimate {
    double value = 0, standard_error = 0;
};

struct PairScale {
    PairModel model = PairModel::thurstone_v;
    std::vector<double> score;          ///< per item, mean 0, unit of F
    std::vector<double> standard_error; ///< of a score relative to the mean of all
    Matrix covariance;                  ///< of the scores
    std::optional<Estimate> order;      ///< b: positive = the first is preferred
    std::optional<Estimate> tie_threshold;
    double log_likelihood = 0;
    double deviance = 0; ///< against one free proportion per PairCount
    int degrees_of_freedom = 0;
    double fit_p = 1; ///< P(deviance or larger), by chi-square; 1 without degrees of freedom
    bool regularised = false;
    std::string note; ///< measures taken to get finite numbers; empty = none
};

/// Fits the scores; a single item has score 0. @throws std::invalid_argument as check_pairs; items not connected
/// by a chain of comparisons; infinite estimates with Regularisation::never; only ties with TieModel::threshold
PairScale fit_pairs(std::span<PairCount const> pairs, int items, PairSettings const& settings = {});

/// @param names of the items, for the message; empty = their numbers
/// @throws std::invalid_argument items not connected by a chain of comparisons
void check_connected(Matrix const& wins, std::vector<std::string> const& names = {});

/// JOD per unit of F: 1 / z(0.75) = 1.4826 for Thurstone's model, 1 / log 3 for Bradley's and Terry's
/// (Perez-Ortiz & Mantiuk 2017, arXiv:1712.03686).
double jod_per_unit(PairModel model);

/// Difference of the scores of `a` and `b`, with Wald's test of "no difference".
struct Difference {
    double value, standard_error, p;
};
Difference difference(PairScale const& scale, int a, int b);

} // namespace study
