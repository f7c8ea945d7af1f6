#pragma once
// Minimum of a smooth function without given derivatives: BFGS (Nocedal & Wright 2006, "Numerical
// Optimization", ch. 6) with central differences and step halving. Neither Eigen nor Boost has it.

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

} // namespace study
