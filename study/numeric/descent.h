#pragma once
// Minimum of a smooth function: BFGS (Nocedal & Wright 2006, "Numerical Optimization", ch. 6) with step halving,
// and with central differences where no derivatives are given. Neither Eigen nor Boost has it.

#include <functional>
#include <span>
#include <vector>

namespace study {

struct Minimum {
    std::vector<double> at;
    double value = 0;
    bool converged = false; ///< the gradient vanished within the accuracy of the differences
};

Minimum minimise(std::function<double(std::span<double const>)> const& f, std::vector<double> const& start,
                 int max_iterations = 500);

/// Computes the gradient at the first argument into the second one.
using GradientAt = std::function<void(std::span<double const>, std::span<double>)>;

/// @param tolerance on the gain of a step, relative to 1 + |value|: the accuracy of the function and its gradient
/// @param first_step about the inverse of the function's second derivatives
Minimum minimise(std::function<double(std::span<double const>)> const& f, GradientAt const& gradient,
                 std::vector<double> const& start, int max_iterations, double tolerance, double first_step = 1);

} // namespace study
