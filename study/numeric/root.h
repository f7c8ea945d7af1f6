#pragma once
// Root of a rising function between two points, by bisection down to the rounding of the bracket.

#include <cmath>

namespace study {

/// @param f rises, f(low) <= 0 <= f(high); otherwise the nearer end is returned
template <class F>
double bisect(F const& f, double low, double high)
{
    for (int i = 0; i < 200; ++i) {
        double const middle = low + 0.5 * (high - low);
        if (middle <= std::fmin(low, high) || middle >= std::fmax(low, high)) break;
        (f(middle) < 0 ? low : high) = middle;
    }
    return low + 0.5 * (high - low);
}

} // namespace study
