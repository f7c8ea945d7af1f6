#pragma once
// How long a method needs to reach an error, by its measured errors after several times. Between two times error
// is a power of time: a line on logarithmic axes.

#include <string_view>
#include <vector>

namespace viewer {

struct ErrorAtTime {
    double seconds = 0, error = 0;
};

enum class Reached : int {
    between_budgets,
    in_first_picture, ///< the shortest time already has no more error; the time is that one, an upper bound
    beyond_budgets,   ///< extrapolated by the last two times
    never             ///< the error no longer falls, or nothing was measured; the time is NaN
};
/// "" for between_budgets.
std::string_view to_text(Reached reached);

struct TimeAtError {
    double seconds = 0;
    Reached reached = Reached::never;
};

/// When the curve first has no more than that error. Points in any order; those without a logarithm are left out.
TimeAtError time_at_error(std::vector<ErrorAtTime> curve, double error);

} // namespace viewer
