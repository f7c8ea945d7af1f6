#pragma once
// Small dense matrices: tables of counts, information and covariance matrices.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace study {

/// Row-major.
struct Matrix {
    std::size_t rows = 0, columns = 0;
    std::vector<double> values;

    Matrix() = default;
    Matrix(std::size_t r, std::size_t c, double value = 0) : rows(r), columns(c), values(r * c, value) {}
    double& operator()(std::size_t r, std::size_t c) { return values[r * columns + c]; }
    double operator()(std::size_t r, std::size_t c) const { return values[r * columns + c]; }
};

/// Lower triangle L with L L^T = a; empty if `a` is not positive definite within rounding.
std::optional<Matrix> cholesky(Matrix const& a);
/// Solves L L^T x = b. @param factor  L, a result of cholesky()
std::vector<double> solve(Matrix const& factor, std::span<double const> b);
/// Inverse of a symmetric, positive definite matrix; empty if it is not positive definite.
std::optional<Matrix> inverse(Matrix const& a);

} // namespace study
