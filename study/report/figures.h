#pragma once
// Parts of a report: its findings in words, and its figures. Each figure is a <figure>, or empty if there is nothing to draw.

#include "study/report/page.h"

namespace study {

/// The main results, one sentence per block: a section of HTML, empty without results.
std::string findings(Analysis const& analysis);

/// Indices of the items, best first.
std::vector<int> by_score(ScaleResult const& scale);
/// The comparison of two items; null = none.
ItemDifference const* difference_of(ScaleResult const& scale, int a, int b);

/// Items by rising score with their intervals; bars at the right join items that do not differ significantly.
/// @param truth true scores by item, in the unit of the scores, NaN = unknown; empty = all unknown
/// @param shared ends of the axis, common to all groups for comparison
std::string scale_figure(ScaleResult const& scale, std::vector<double> const& truth, Interval const& shared,
                         std::string const& title);
/// Score against rendering time per frame, with the cheapest item marked.
std::string cost_figure(ScaleResult const& scale, std::string const& title);
/// Table of how often the row was chosen over the column, with significant differences marked.
std::string wins_table(ScaleResult const& scale, double level);
/// Proportions of the given ratings, by item.
std::string spread_figure(ScaleResult const& scale, RatingScale const& rating, std::string const& title);

/// Correct answers by level with the fitted function.
/// @param truth true level at the function's proportion; NaN = unknown
std::string curve_figure(CurveResult const& curve, BlockResult const& block, std::string const& setting,
                         double truth);
/// Small plots of single runs, at most 24.
std::string tracks_figure(std::vector<ThresholdRun> const& runs, BlockResult const& block,
                          std::string const& title, double truth);
/// Estimates of a threshold by all methods.
/// @param truth true level for each estimate
std::string thresholds_figure(std::vector<ThresholdSummary> const& thresholds, BlockResult const& block,
                              std::vector<double> const& truth, std::string const& title);

/// Proportions correct by condition, with that of guessing.
std::string detections_figure(std::vector<DetectionResult> const& detections, double guess,
                              std::string const& title);

std::string histogram(std::vector<double> const& values, std::string const& label, std::string const& title);
/// Shaded table of transitions from (row) and to (column).
std::string transitions_table(TransitionResult const& transitions);

} // namespace study
