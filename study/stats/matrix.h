#pragma once
// Small dense matrices: tables of counts, informations, covariances.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace study {

/// Row by row.
struct Matrix {
    std::size_t rows = 0, columns = 0;
    std::vector<double> values;

    Matrix() = default;
    Matrix(std::size_t r, std::size_t c, double value = 0) : rows(r), columns(c), values(r * c, value) {}
    double& operator()(std::size_t r, std::size_t c) { return values[r * columns + c]; }
    double operator()(std::size_t r, std::size_t c) const { return values[r * columns + c]; }
};

/// The lower triangle L with L L^T = a; nothing where `a` is not positive definite to rounding.
std::optional<Matrix> cholesky(Matrix const& a);
/// x with L L^T x = b. @param factor of cholesky()
std::vector<double> solve(Matrix const& factor, std::span<double const> b);
/// The inverse of a symmetric, positive definite matrix, if it is one.
std::optional<Matrix> inverse(Matrix const& a);

} // namespace study
