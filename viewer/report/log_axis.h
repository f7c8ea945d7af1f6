#pragma once
#include <string>
#include <vector>

namespace viewer {

/// A logarithmic axis from one round number to another.
struct LogAxis {
    double low = 1, high = 10;
    std::vector<double> ticks;

    /// 0 at low, 1 at high.
    double position(double value) const;
};

/// Holds all values (> 0) between steps of 1, 2, 5; ticks at those, or at powers of ten where there would be many.
LogAxis make_axis(std::vector<double> const& values);
/// "0.05", "2000", "3·10⁻⁵"
std::string tick_text(double value);

} // namespace viewer
