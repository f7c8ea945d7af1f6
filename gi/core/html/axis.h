#pragma once
// The axes of plots: their ends, ticks and labels.

#include <string>
#include <vector>

namespace gi {

/// Number with three digits, integers with up to seven: "0.05", "1250", "−3.2·10⁻⁵".
std::string short_number(double value);

/// An axis of a plot.
struct PlotAxis {
    double low = 0, high = 1; ///< of its ends; low may be above high
    bool is_log = false;      ///< both ends are above 0 then

    /// Position of a value, 0 at low, 1 at high; values beyond are placed just outside.
    double position(double value) const;
    /// Round numbers within the ends. @param about how many on a linear axis
    std::vector<double> ticks(int about) const;
};
/// Axis over all finite values (logarithmic: all above 0), with a margin at both ends; [0, 1] if there are none.
PlotAxis axis_over(std::vector<double> const& values, bool is_log = false, double margin = 0.06);

} // namespace gi
