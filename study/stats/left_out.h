#pragma once
// How a scale of pairs changes by leaving out one observer's choices (the jackknife:
// Miller 1974, Biometrika 61:1). Unlike influences, which are derivatives, such changes know that
// far-off choices weigh more, the farther off.

#include "study/stats/pair_likelihood.h"

#include <Eigen/Core>
#include <span>

namespace study {

/// `at` minus the parameters of the fit with Jeffreys' prior to all choices except `own`, which determine them, by
/// three steps from `at`: more would change variances by 3 % at most.
/// @param at  of the fit with Jeffreys' prior to the pooled choices
Eigen::VectorXd change_without(std::span<PairCount const> pooled, std::span<PairCount const> own, PairModel model,
                               PairParameters const& layout, std::span<double const> at);

} // namespace study
