#pragma once
#include <string>
#include <vector>

namespace viewer {

/// Logarithmic axis between two round numbers.
struct LogAxis {
    double low = 1, high = 10;
    std::vector<double> ticks;

    /// Position of a value: 0 at low, 1 at high.
    double position(double value) const;
};

/// Axis that contains all values (> 0), with ends and ticks at steps of 1, 2, 5, or only at powers of ten if there
/// would be too many.
LogAxis make_axis(std::vector<double> const& values);
/// Formats a tick: "0.05", "2000", "3·10⁻⁵"
std::string tick_text(double value);

} // namespace viewer
