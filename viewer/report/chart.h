#pragma once
// Curves on two logarithmic axes as inline SVG. Colours and fonts come from the page's style sheet: curve i has
// the class "curve ci", i counted modulo kCurveStyles.

#include <string>
#include <vector>

namespace viewer {

inline constexpr std::size_t kCurveStyles = 6;

struct CurvePoint {
    double x = 0, y = 0;
    double y_low = 0, y_high = 0; ///< range of the measurements
};

struct Curve {
    std::string label;
    std::vector<CurvePoint> points;
};

struct Chart {
    std::string title, x_label, y_label;
    std::vector<Curve> curves;
    double level = 0; ///< horizontal dashed line; 0 = none
    std::string level_label;
};

/// Draws the chart as SVG. Points without a logarithm are left out; a note below the chart gives their number.
std::string to_svg(Chart const& chart);

} // namespace viewer
