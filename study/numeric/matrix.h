#pragma once
// Small dense matrices: tables of counts, information and covariance matrices.

#include <cstddef>
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

} // namespace study
