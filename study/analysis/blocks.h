#pragma once
// The analysis of one block, by kind of task. Each function writes its results into `result`.

#include "study/analysis/groups.h"

namespace study {

/// Analyses blocks of pairs: Thurstone's case V scale in JOD, with intervals and differences by
/// errors over observers, ties (if allowed) by a threshold, the Bradley-Terry scale, goodness of fit,
/// order effect, agreement. Adds circular triads and outlier scores to the summaries of observers,
/// which are in the same order as `observers`.
void analyze_pairs(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                   AnalysisSettings const& settings, BlockResult& result, std::vector<ObserverSummary>& summaries);

/// Mean over observers of ratings, logarithms of magnitudes or adjusted levels; Friedman's test; for ratings also
/// a model with bias and inconsistency of observers.
void analyze_values(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                    AnalysisSettings const& settings, BlockResult& result);

/// Plackett-Luce utilities and mean ranks of rankings.
void analyze_rankings(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                      AnalysisSettings const& settings, BlockResult& result);

/// Thresholds by each procedure, and psychometric functions, of a block whose level varies.
/// @param trials counted ones of the block, by observer
void analyze_thresholds(Script const& script, Block const& block, std::vector<ObserverTrials> const& trials,
                        std::vector<Group> const& groups, AnalysisSettings const& settings, BlockResult& result);

/// Thresholds, psychometric functions and d' of tasks with a correct answer.
void analyze_detection(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                       AnalysisSettings const& settings, BlockResult& result);

} // namespace study
