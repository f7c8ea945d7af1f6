#pragma once
#include "study/analysis/groups.h"

namespace study {

/// Thurstone's case V scale in JOD, with intervals and differences by a bootstrap over observers, Bradley and
/// Terry's beside it, goodness of fit, order effect, agreement; of blocks of pairs. Adds circular triads and
/// outlier scores to the summaries of observers, which are in the same order as `observers`.
void analyze_pairs(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                   AnalysisSettings const& settings, BlockResult& result, std::vector<ObserverSummary>& summaries);

/// Mean over observers of ratings, logarithms of magnitudes or adjusted levels; Friedman's test; of ratings a
/// model with bias and inconsistency of observers too.
void analyze_values(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                    AnalysisSettings const& settings, BlockResult& result);

/// Plackett and Luce's utilities and mean ranks of rankings.
void analyze_rankings(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                      AnalysisSettings const& settings, BlockResult& result);

/// Thresholds, psychometric functions and d' of tasks with a right answer.
void analyze_detection(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                       AnalysisSettings const& settings, BlockResult& result);

} // namespace study
