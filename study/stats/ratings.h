#pragma once
// Ratings on a scale. Tables are items x observers; NaN = not rated.

#include "study/stats/binomial.h"
#include "study/stats/matrix.h"

#include <string>

namespace study {

/// The mean opinion score of one item over its observers, and Student's interval of it.
struct MeanOpinion {
    int observers = 0;
    double mean = 0;           ///< NaN of nobody
    double deviation = 0;      ///< n - 1; NaN of fewer than two
    double standard_error = 0; ///< as deviation
    Interval interval;         ///< as deviation
};
/// @throws std::invalid_argument a rating that is infinite, a confidence outside of (0, 1)
std::vector<MeanOpinion> mean_opinions(Matrix const& ratings, double confidence = 0.95);

/// Observers x items, as friedman() wants it.
Matrix transposed(Matrix const& table);

/// Quality that allows for observers who rate lower than others or carelessly (Li, Bampis, Krasula, Janowski &
/// Katsavounidis 2020, "A simple model for subject behavior in subjective experiments", HVEI; ITU-T P.910 Annex
/// E):
///   u_jo = quality_j + bias_o + inconsistency_o e,  e standard normal,
/// by maximum likelihood, in turns: bias, inconsistency, quality weighted by 1 / inconsistency^2. The biases have
/// mean 0.
struct RatingModel {
    std::vector<double> quality, quality_error;
    std::vector<double> bias, bias_error;
    std::vector<double> inconsistency;
    int iterations = 0;
    bool converged = false;
    std::string note; ///< empty = nothing to say
};
/// An inconsistency is never below a fiftieth of that of all: the likelihood of somebody who repeats the model
/// exactly would be infinite. NaN for items and observers without ratings.
/// @throws std::invalid_argument no ratings, or one that is infinite
RatingModel fit_ratings(Matrix const& ratings);

} // namespace study
