#pragma once
// Hierarchical Bayesian models of groups of observers: every observer has parameters of his or her own, drawn from
// normal distributions whose means and standard deviations are estimated too. Draws are those of sampler.h; each
// observer's parameters are mean + standard deviation * standard normal number (non-centred), which leaves no
// funnel for few trials.
//
// The standard deviation s of d' or thresholds between observers has the reference prior of random effects,
//   sqrt(sum over observers of (s / (s^2 + v))^2),
// v being the variance of an observer's own estimate (Bodnar, Link, Arendacka, Possolo & Elster 2017, Stat. Med.
// 36:378), times a wide half-normal density, which bounds it for few observers. It vanishes at 0 and is largest
// near the errors of observers' estimates. A half-normal density alone does not vanish, and takes observers who
// differ by about those errors as too equal: 95 % intervals of observers held 93 %.
//
// d': d' and criterion of each observer; priors: means N(0, 2^2), standard deviations
// half-normal (2, of criteria 1).
// Psychometric function: threshold (at a proportion correct), log scale and logit of the lapse rate of each
// observer, a common overdispersion; in units of the range of levels: mean threshold N(0, 1) from the middle, its
// standard deviation half-normal (1); log scale N(log 1/8, 1), half-normal (0.5); lapse rate L logistic(y), L =
// 0.2, but at most 0.9 (1 - proportion), y N(-1.7, 1), half-normal (0.5); eta Beta(1, 10).

#include "study/stats/detection_model.h"
#include "study/stats/group_threshold.h"
#include "study/stats/sampler.h"

#include <span>
#include <string>
#include <vector>

namespace study {

struct Hierarchical {
    Posterior mean, deviation;       ///< of the parameter of interest in the population
    std::vector<Posterior> observer; ///< of each observer with trials, in their order: shrunken towards the mean
    Posterior scale, lapse;          ///< of psychometric functions: the population's
    SamplerReport report;
    std::string note; ///< what the diagnostics find wrong; empty = nothing
};

/// d' as in group_dprime. @throws std::invalid_argument as group_dprime
Hierarchical hierarchical_dprime(DetectionTask task, std::span<DetectionCounts const> observers,
                                 double confidence = 0.95, SamplerSettings const& sampler = {});

/// Thresholds as in group_threshold, in units of u. `fits_guess` is ignored: the observers' own rates are used.
/// @throws std::invalid_argument as group_threshold
Hierarchical hierarchical_psychometric(std::span<ObserverLevels const> observers,
                                       GroupThresholdSettings const& settings,
                                       SamplerSettings const& sampler = {});

} // namespace study
