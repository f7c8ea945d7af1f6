#pragma once
// Scores that are known only up to a constant: fitted with the first item at 0, reported with mean 0.

#include "study/stats/likelihood.h"

namespace study {

struct Scores {
    std::vector<double> score;          ///< per item, mean 0
    std::vector<double> standard_error; ///< of a score against the mean of all
    Matrix covariance;
};

/// @param fit  its first `items` - 1 parameters are the scores of items 1, 2, ... against item 0
Scores centred(MaximumLikelihood const& fit, std::size_t items);

/// Whether estimates went off to infinity: they are stopped where nothing can be gained any more, and have no
/// error to speak of there.
bool runs_off(MaximumLikelihood const& fit);

} // namespace study
