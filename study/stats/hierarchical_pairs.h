#pragma once
// Scores from pairs with observers as random effects, by a Bayesian model:
//   P(o chooses i over j) = Phi(s_oi - s_oj - t),  s_oi = mu_i + sd z_oi,  z_oi ~ N(0, 1),
// with the threshold t of ties if there are any (Glenn & David 1960), else 0. Priors are weak: mu_i - mu_0 ~ N(0, 2^2),
// sd half normal with 0.7, log t ~ N(log 0.3, 1), in units of one trial's noise. Draws are those of sampler.h.
//
// mu is the mean over observers of their own scales. The scale of pooled choices (pair_scale.h) is smaller by
// 1 / sqrt(1 + 2 sd^2), because observers who differ agree less.

#include "study/stats/pairs.h"
#include "study/stats/sampler.h"

namespace study {

struct HierarchicalScale {
    std::vector<Posterior> score;              ///< mu per item, mean 0, unit of a trial's noise
    std::vector<Posterior> difference;         ///< of items a < b, in that order
    Posterior between_sd;                      ///< sd
    Posterior tie_threshold;                   ///< t; 0 without ties
    std::vector<std::vector<double>> observer; ///< by observer: posterior mean of his or her scores, mean 0
    SamplerReport report;
    std::string note; ///< what is wrong with the draws; empty = nothing
};

/// @param observers  the pairs of each, in any order
/// @throws std::invalid_argument as check_pairs; fewer than two observers or items; items not connected
HierarchicalScale hierarchical_scale(std::vector<std::vector<PairCount>> const& observers, int items,
                                     double confidence = 0.95, SamplerSettings const& settings = {});

} // namespace study
