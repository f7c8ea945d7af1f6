#pragma once
// Scores determined only up to a constant: fitted with the first item at 0, reported with mean 0.

#include "study/stats/likelihood.h"

namespace study {

struct Scores {
    std::vector<double> score;          ///< per item, mean 0
    std::vector<double> standard_error; ///< of a score relative to the mean of all
    Matrix covariance;
};

/// @param fit  its first `items` - 1 parameters are the scores of items 1, 2, ... relative to item 0
Scores centred(MaximumLikelihood const& fit, std::size_t items);

/// True if estimates diverged to infinity: the fit stopped where the likelihood no longer grows, and their
/// standard errors are meaningless.
bool runs_off(MaximumLikelihood const& fit);

} // namespace study
