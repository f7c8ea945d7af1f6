#pragma once
// Curves on two logarithmic axes as inline SVG. Colours and fonts come from the page's style sheet: curve i has
// the class "curve ci", i counted modulo kCurveStyles.

#include <string>
#include <vector>

namespace viewer {

inline constexpr std::size_t kCurveStyles = 6;

struct CurvePoint {
    double x = 0, y = 0;
    double y_low = 0, y_high = 0; ///< its spread
};

struct Curve {
    std::string label;
    std::vector<CurvePoint> points;
};

struct Chart {
    std::string title, x_label, y_label;
    std::vector<Curve> curves;
    double level = 0; ///< a dashed line across; 0 = none
    std::string level_label;
};

/// Points that have no logarithm are left out; a last line below the axis counts them.
std::string to_svg(Chart const& chart);

} // namespace viewer
