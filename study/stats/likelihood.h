#pragma once
// Maximum likelihood by Fisher scoring with Levenberg's damping, within bounds. A model gives its log-likelihood,
// the gradient of it and the expected information; the inverse of that is the covariance of the estimate.

#include "study/numeric/matrix.h"

#include <functional>
#include <limits>
#include <span>

namespace study {

struct Likelihood {
    double log_likelihood = 0;
    std::vector<double> gradient;
    Matrix information; ///< expected; symmetric

    /// Sets everything to zero, for n parameters.
    void clear(std::size_t n);
};

/// Fills the second argument for the given parameters; log_likelihood -infinity or NaN = impossible parameters.
using LikelihoodAt = std::function<void(std::span<double const>, Likelihood&)>;

struct Bound {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

struct MaximumLikelihood {
    std::vector<double> estimate;
    Matrix covariance; ///< of parameters not at a bound; zero for those at a bound, NaN if singular
    double log_likelihood = 0;
    bool converged = false;
    std::vector<bool> at_bound;
};

/// @param start  within the bounds  @param bounds  one per parameter, or empty
MaximumLikelihood maximise(LikelihoodAt const& model, std::vector<double> start,
                           std::vector<Bound> const& bounds = {}, int max_iterations = 200);

/// Adds Jeffreys' prior to a model: half the log of the determinant of the information. It makes infinite
/// estimates of a binomial model finite, removes their bias to first order, and does not depend on how scores are
/// anchored (Firth 1993, Biometrika 80:27; for links other than the logit Kosmidis & Firth 2021, Biometrika
/// 108:71). Its gradient is computed by central differences.
LikelihoodAt with_jeffreys_prior(LikelihoodAt model);

} // namespace study
