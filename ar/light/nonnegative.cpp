#include "ar/light/nonnegative.h"

#include <algorithm>
#include <cmath>

namespace ar {

std::vector<double> solve_nonnegative(cv::Mat const& Q, std::vector<double> const& g,
                                      std::vector<double> const& lower, int most_turns)
{
    int const n = Q.rows;
    CV_Assert(Q.type() == CV_64F && Q.cols == n && int(g.size()) == n && int(lower.size()) == n);
    // Start: without bounds, then clamped.
    cv::Mat start;
    cv::solve(Q, cv::Mat(g), start, cv::DECOMP_CHOLESKY);
    std::vector<double> x(lower), slope(g.size()); // slope = Qx - g
    for (int i = 0; i < n; ++i) x[std::size_t(i)] = std::max(lower[std::size_t(i)], start.at<double>(i));
    for (int i = 0; i < n; ++i) {
        double sum = -g[std::size_t(i)];
        for (int j = 0; j < n; ++j) sum += Q.ptr<double>(i)[j] * x[std::size_t(j)];
        slope[std::size_t(i)] = sum;
    }
    for (int turn = 0; turn < most_turns; ++turn) {
        double most = 0, largest = 0;
        for (int i = 0; i < n; ++i) {
            double const* const row = Q.ptr<double>(i);
            double& value = x[std::size_t(i)];
            double const next = std::max(lower[std::size_t(i)], value - slope[std::size_t(i)] / row[i]);
            double const step = next - value;
            largest = std::max(largest, std::abs(next));
            if (step == 0) continue;
            most = std::max(most, std::abs(step));
            value = next;
            for (int j = 0; j < n; ++j) slope[std::size_t(j)] += step * row[j];
        }
        if (most <= 1e-6 * largest) break;
    }
    return x;
}

} // namespace ar
