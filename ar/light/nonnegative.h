#pragma once
// Least squares with lower bounds: the x >= lower that minimises 1/2 x'Qx - g'x.

#include <opencv2/core.hpp>
#include <vector>

namespace ar {

/// Cyclic coordinate descent (Franc, Hlavac and Navara 2005). Ends when no value changes by more than 1e-6 of the
/// largest, or after `most_turns` turns over all values.
/// @param Q  n x n, CV_64F, symmetric, positive diagonal
std::vector<double> solve_nonnegative(cv::Mat const& Q, std::vector<double> const& g,
                                      std::vector<double> const& lower, int most_turns = 2000);

} // namespace ar
