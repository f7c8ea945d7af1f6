#pragma once
// The root of a rising function between two points, by halving until the bracket is no wider than its rounding.

#include <cmath>

namespace study {

/// @param f rises, f(low) <= 0 <= f(high); where it is not so, the nearer end is returned
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
