#pragma once
// The drawings of a report. Each is a <figure>, or empty where there is nothing to draw.

#include "study/report/page.h"

namespace study {

/// Items by rising score with their intervals; bars at the right join items that do not differ significantly.
/// @param truth by item, in the unit of the scores, NaN = unknown; empty = none is known
/// @param shared ends of the axis, so that groups can be compared
std::string scale_figure(ScaleResult const& scale, std::vector<double> const& truth, Interval const& shared,
                         std::string const& title);
/// Score against the time to render a frame, with the cheapest item marked.
std::string cost_figure(ScaleResult const& scale, std::string const& title);
/// How often the row was chosen over the column, as a table, with the differences that are significant.
std::string wins_table(ScaleResult const& scale, double level);
/// Shares of the values that were given, by item.
std::string spread_figure(ScaleResult const& scale, RatingScale const& rating, std::string const& title);

/// Right answers by level with the fitted function.
/// @param truth level at the function's share; NaN = unknown
std::string curve_figure(CurveResult const& curve, BlockResult const& block, std::string const& setting,
                         double truth);
/// Small drawings of single runs, of at most 24.
std::string tracks_figure(std::vector<ThresholdRun> const& runs, BlockResult const& block,
                          std::string const& title, double truth);
/// Estimates of a threshold by all methods.
/// @param truth by estimate
std::string thresholds_figure(std::vector<ThresholdSummary> const& thresholds, BlockResult const& block,
                              std::vector<double> const& truth, std::string const& title);

/// Shares of right answers by condition, with the share of guessing.
std::string detections_figure(std::vector<DetectionResult> const& detections, double guess,
                              std::string const& title);

std::string histogram(std::vector<double> const& values, std::string const& label, std::string const& title);
/// From (row) and to (column) as a table with shades.
std::string transitions_table(TransitionResult const& transitions);

} // namespace study
