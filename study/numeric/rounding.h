#pragma once
// Whether numbers differ, or only their roundings. Numbers that are equal in exact arithmetic (such as the difference
// of 20.1 and 10.1 and that of 20 and 10) differ by some units of the last place of the largest number that entered.

#include <cmath>
#include <limits>

namespace study {

/// Differences up to this share of the size of the numbers that entered are rounding. R's t.test calls data "essentially
/// constant" below 10 machine epsilons; means and contrasts of many numbers need some more.
inline constexpr double kRounding = 32 * std::numeric_limits<double>::epsilon();
/// In the natural unit of a fitted number (1 JOD, 1 of d', a factor of e): what solvers leave of a 0.
inline constexpr double kSolverNoise = 1e-9;

/// @param size  magnitude of the largest number that entered, in the unit of the difference. NaN: false
inline bool is_rounding(double difference, double size) { return std::abs(difference) <= kRounding * size; }
/// 0 if the value is rounding.
inline double without_rounding(double value, double size) { return is_rounding(value, size) ? 0 : value; }
/// 0 if the fitted value is a solver's noise.
inline double without_noise(double fitted) { return std::abs(fitted) < kSolverNoise ? 0 : fitted; }

} // namespace study
