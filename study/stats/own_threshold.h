#pragma once
// The threshold of one run, by its own answers and the function of the group (group_threshold.h): a run of 25
// trials does not determine a slope. Lapse rate and overdispersion are those of the group; its scale is known but
// for its standard error, that of the other observers, as the run's own answers count by their likelihood.
//
// The prior of the threshold is Jeffreys', the root of the information that trials have about it: its intervals
// hold as often as they say to the second order (Welch & Peers 1963, J. R. Stat. Soc. B 25:318). Where levels are
// fixed the information is that of the levels shown. Levels that follow the answers lie where they inform,
// wherever the threshold is in the range: the information is that of a trial at the best level of the range. So
// beyond the levels thresholds become unlikely as soon as answers could not tell them; even priors made intervals
// there twice as wide, and held fewer thresholds near the ends of the range.

#include "study/stats/group_threshold.h"
#include "study/stats/psychometric_posterior.h"

namespace study {

/// @throws std::invalid_argument as group_threshold
PosteriorLevel own_threshold(ObserverLevels const& observer, GroupThreshold const& group,
                             GroupThresholdSettings const& settings);

} // namespace study
