#pragma once
// The minimum of a smooth function without derivatives of its own: BFGS (Nocedal & Wright 2006, "Numerical
// Optimization", ch. 6) with central differences and halving of steps.

#include <functional>
#include <span>
#include <vector>

namespace study {

struct Minimum {
    std::vector<double> at;
    double value = 0;
    bool converged = false; ///< the gradient vanished within what differences can tell
};

Minimum minimise(std::function<double(std::span<double const>)> const& f, std::vector<double> start,
                 int max_iterations = 500);

} // namespace study
