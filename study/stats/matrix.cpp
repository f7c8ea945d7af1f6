#include "study/stats/matrix.h"

#include <cmath>

namespace study {

std::optional<Matrix> cholesky(Matrix const& a)
{
    std::size_t const n = a.rows;
    Matrix l(n, n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = a(i, j);
            for (std::size_t k = 0; k < j; ++k) sum -= l(i, k) * l(j, k);
            if (i != j) {
                l(i, j) = sum / l(j, j);
            } else {
                if (!(sum > 1e-14 * a(i, i)) || !std::isfinite(sum)) return std::nullopt;
                l(i, i) = std::sqrt(sum);
            }
        }
    return l;
}

std::vector<double> solve(Matrix const& factor, std::span<double const> b)
{
    std::size_t const n = factor.rows;
    std::vector<double> x(b.begin(), b.end());
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) x[i] -= factor(i, k) * x[k];
        x[i] /= factor(i, i);
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) x[i] -= factor(k, i) * x[k];
        x[i] /= factor(i, i);
    }
    return x;
}

std::optional<Matrix> inverse(Matrix const& a)
{
    std::optional<Matrix> const factor = cholesky(a);
    if (!factor) return std::nullopt;
    std::size_t const n = a.rows;
    Matrix result(n, n);
    std::vector<double> unit(n);
    for (std::size_t c = 0; c < n; ++c) {
        unit[c] = 1;
        std::vector<double> const column = solve(*factor, unit);
        unit[c] = 0;
        for (std::size_t r = 0; r < n; ++r) result(r, c) = column[r];
    }
    return result;
}

} // namespace study
