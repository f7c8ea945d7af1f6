#pragma once
// Maximum of a function of a few parameters, of which some are free, within bounds.

#include "study/numeric/descent.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace study {

template <std::size_t N>
struct Bounds {
    std::array<double, N> low{}, high{}; ///< beyond them the function is replaced by a rising penalty
};

/// Moves the free parameters of `at` to the maximum near it. @return the maximum; -infinity if no value is finite
/// @param function  function(p, gradient) returns the value at p, and sets the gradient
/// @param first_step  as minimise()
template <std::size_t N, class Function>
double maximise_within(Bounds<N> const& bounds, std::array<double, N>& at, std::vector<int> const& free,
                       int max_iterations, double first_step, Function const& function)
{
    constexpr double kNowhere = 1e300; // instead of values that are not finite
    std::array<double, N> gradient{};
    if (free.empty()) return function(at, gradient);
    std::vector<double> x, known;
    for (int const i : free) x.push_back(at[std::size_t(i)]);
    auto const evaluate = [&](std::span<double const> v) {
        known.assign(v.begin(), v.end());
        std::array<double, N> p = at;
        double outside = 0;
        for (std::size_t i = 0; i < free.size(); ++i) {
            auto const k = std::size_t(free[i]);
            p[k] = std::clamp(v[i], bounds.low[k], bounds.high[k]);
            outside += (v[i] - p[k]) * (v[i] - p[k]);
        }
        double const value = function(p, gradient);
        for (std::size_t i = 0; i < free.size(); ++i)
            gradient[std::size_t(free[i])] -= 2 * (v[i] - p[std::size_t(free[i])]);
        return std::isfinite(value) ? outside - value : kNowhere;
    };
    auto const slope = [&](std::span<double const> v, std::span<double> g) {
        if (!std::equal(v.begin(), v.end(), known.begin(), known.end())) evaluate(v);
        for (std::size_t i = 0; i < free.size(); ++i) g[i] = -gradient[std::size_t(free[i])];
    };
    Minimum const m = minimise(evaluate, slope, x, max_iterations, 1e-6, first_step);
    for (std::size_t i = 0; i < free.size(); ++i) at[std::size_t(free[i])] = m.at[i];
    return m.value < kNowhere ? -m.value : -std::numeric_limits<double>::infinity();
}

} // namespace study
