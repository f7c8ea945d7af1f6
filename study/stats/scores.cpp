#include "study/stats/scores.h"

#include <algorithm>
#include <cmath>

namespace study {

Scores centred(MaximumLikelihood const& fit, std::size_t n)
{
    std::vector<double> s(n, 0);
    Matrix c(n, n);
    for (std::size_t i = 1; i < n; ++i) {
        s[i] = fit.estimate[i - 1];
        for (std::size_t j = 1; j < n; ++j) c(i, j) = fit.covariance(i - 1, j - 1);
    }
    double mean = 0, mean_c = 0;
    std::vector<double> row(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        mean += s[i] / double(n);
        for (std::size_t j = 0; j < n; ++j) row[i] += c(i, j) / double(n);
        mean_c += row[i] / double(n);
    }
    Scores result;
    result.covariance = Matrix(n, n);
    for (std::size_t i = 0; i < n; ++i) {
        result.score.push_back(s[i] - mean);
        for (std::size_t j = 0; j < n; ++j) result.covariance(i, j) = c(i, j) - row[i] - row[j] + mean_c;
        result.standard_error.push_back(std::sqrt(std::max(0.0, result.covariance(i, i))));
    }
    return result;
}

bool runs_off(MaximumLikelihood const& fit)
{
    for (std::size_t i = 0; i < fit.estimate.size(); ++i)
        if (!(fit.covariance(i, i) < 1e4)) return true;
    return false;
}

} // namespace study
