#pragma once
// Ratings on a scale. Tables are items x observers; NaN = not rated.

#include "study/numeric/matrix.h"
#include "study/stats/binomial.h"

#include <span>
#include <string>

namespace study {

/// Mean opinion score of one item over its observers, with Student's confidence interval.
struct MeanOpinion {
    int observers = 0;
    double mean = 0;           ///< NaN without observers
    double deviation = 0;      ///< standard deviation with n - 1; NaN for fewer than two observers
    double standard_error = 0; ///< as deviation
    Interval interval;         ///< as deviation; NaN also where the observers do not vary
    /// The interval allowing for skewness, as near the ends of a scale: Hall's transformation of Student's t
    /// (1992, J. R. Stat. Soc. B 54:221) with half of the sample's skewness, which few ratings overstate.
    Interval skewed;
};
/// @throws std::invalid_argument an infinite rating, a confidence outside (0, 1)
std::vector<MeanOpinion> mean_opinions(Matrix const& ratings, double confidence = 0.95);

/// Transposed table, observers x items, as friedman() needs it.
Matrix transposed(Matrix const& table);

/// One rating; an observer may rate an item several times.
struct Rating {
    int item = 0, observer = 0;
    double value = 0;
};

/// Quality that accounts for observers who rate lower than others or carelessly (Li, Bampis,
/// Krasula, Janowski & Katsavounidis 2020, "A simple model for subject behavior in subjective
/// experiments", HVEI; ITU-T P.910 Annex E):
///   u_jor = quality_j + bias_o + inconsistency_o e,  e standard normal, r-th rating,
/// by maximum likelihood, alternating: bias, inconsistency, quality weighted by 1 / inconsistency^2.
/// The biases have mean 0.
///
/// With few ratings of each observer this often runs to where quality equals the ratings of one, whose likelihood
/// is infinite (inconsistency below a fiftieth of that of all). Then the fit is `shrunken`: the mean square of all
/// observers counts as 5 ratings of each.
struct RatingModel {
    std::vector<double> quality, quality_error;
    std::vector<double> bias, bias_error;
    std::vector<double> inconsistency;
    bool shrunken = false;
    int iterations = 0;
    bool converged = false;
    std::string note; ///< a remark; empty = none
};
/// NaN for items and observers without ratings. @throws std::invalid_argument no ratings, or one that is not
/// finite; an item or observer that does not exist
RatingModel fit_ratings(std::span<Rating const> ratings, int items, int observers);

} // namespace study
