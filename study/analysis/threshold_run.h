#pragma once
// Thresholds from the runs of staircases and QUEST+: of single runs, observers and groups.

#include "study/analysis/groups.h"
#include "study/stats/group_threshold.h"
#include "study/stats/shrunken_rates.h"
#include "study/stats/step_gap.h"

namespace study {

/// Converts a value in units of the scale, such as a mean of reversals, to a level.
double back_to_level(Compare const& compare, double on_scale);

/// One run of one procedure by one observer, in the order of its trials, with its reversals; without estimates.
/// @param trials of this run, valid ones with an answer
ThresholdRun threshold_run(Block const& block, Procedure const& procedure, std::vector<TrialRow> const& trials);

/// What the trials of an observer without a signal say of guessing: the task's guess rate, or the false alarm rate
/// (log-linear); none if there are no trials to estimate it.
std::optional<double> lowest_share(Task task, std::vector<TrialRow> const& trials);
/// False alarms among the trials without a signal.
RateCount false_alarms(std::vector<TrialRow> const& trials);

/// A group's threshold and its functions, in the units of group_threshold.h.
struct GroupCurve {
    GroupThresholdSettings settings;
    GroupThreshold threshold;
};

/// The mean of the last reversals, corrected for what simulated runs of this staircase find too high or low with
/// the group's function; the interval holds the thresholds at which such runs give this mean by chance.
ThresholdEstimate reversal_estimate(ThresholdRun const& run, Block const& block, Procedure const& procedure,
                                    std::optional<GroupCurve> const& group, AnalysisSettings const& settings);
/// "below" or "above" if the level lies beyond these; empty if it does not, or is unknown.
std::string outside_of(double level, double low, double high);
/// Adds a note and a doubt if the estimate lies beyond all levels that the run has shown.
void note_outside(ThresholdRun const& run, ThresholdEstimate& estimate);
/// Which end of a grid a posterior is cut at: its value there is at least half of the largest one.
/// @param posterior  of each value of the grid, which rises, where the prior is not 0
/// @return "lower" or "upper", "lower and upper" where little was learned; empty = at none, or the grid is one point
std::string cut_end(std::vector<double> const& posterior);
/// "the interval is open above" (or below) if an end of the interval is unknown; empty if both are known.
std::string open_ends(Interval const& interval);
/// Note on a posterior's interval with an unknown end: "the interval is open above ..."; empty if both are known.
/// @param tail  the probability beyond each end
std::string note_of_open_ends(Interval const& interval, double tail);
/// The threshold by the run's own trials: with the group's scale and lapse rate if there are three observers or
/// more, otherwise with weak priors of both (psychometric_posterior.h).
ThresholdEstimate likelihood_estimate(ThresholdRun const& run, Block const& block,
                                      PsychometricChoice const& function, std::optional<double> guess,
                                      double proportion, std::optional<GroupCurve> const& group,
                                      AnalysisSettings const& settings);
/// The median and the quantiles of the level at which the proportion is reached,
/// by the posterior of all parameters.
ThresholdEstimate questplus_estimate(ThresholdRun const& run, Block const& block, Procedure const& procedure,
                                     double proportion, AnalysisSettings const& settings);

} // namespace study
