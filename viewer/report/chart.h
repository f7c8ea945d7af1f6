#pragma once
// Charts of error against time for reports.

#include "gi/core/html/plot.h"

namespace viewer {

/// Curves on two logarithmic axes.
struct Chart {
    std::string title, x_label, y_label;
    std::vector<gi::PlotSeries> curves;
    double level = 0; ///< horizontal dashed line; 0 = none
    std::string level_label;
};

/// Draws the chart as a figure. Points without a logarithm are left out;
/// a note below the chart gives their number.
std::string to_figure(Chart const& chart);

} // namespace viewer
