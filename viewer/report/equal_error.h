#pragma once
// Time that a method needs to reach an error, from its measured errors after several times. Between two times, the
// error is interpolated as a power of time, i.e. linearly on logarithmic axes.

#include <string_view>
#include <vector>

namespace viewer {

struct ErrorAtTime {
    double seconds = 0, error = 0;
};

enum class Reached : int {
    between_budgets,
    in_first_picture, ///< reached already after the shortest time, which is returned as an upper bound
    beyond_budgets,   ///< extrapolated from the last two times
    never             ///< the error does not fall any more, or nothing was measured; the time is NaN
};
/// Description; "" for between_budgets.
std::string_view to_text(Reached reached);

struct TimeAtError {
    double seconds = 0;
    Reached reached = Reached::never;
};

/// First time at which the curve is at or below `error`. Points may be in any order;
/// those without a logarithm are ignored.
TimeAtError time_at_error(std::vector<ErrorAtTime> curve, double error);

} // namespace viewer
