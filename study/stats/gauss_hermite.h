#pragma once
// Nodes x and weights w of Gauss and Hermite: the integral of exp(-x^2) f(x) is about the sum of w f(x), exact for
// polynomials of degree 2 n - 1.

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <vector>

namespace study {

struct QuadratureNode {
    double x = 0, weight = 0;
    double log_weight = 0; ///< log(weight) + x^2: of a rule for the integral of f itself
};
/// Golub & Welsch 1969: nodes are eigenvalues of the matrix of the recurrence. @param n 1 to 40
inline std::vector<QuadratureNode> gauss_hermite(int n)
{
    Eigen::MatrixXd recurrence = Eigen::MatrixXd::Zero(n, n);
    for (int i = 1; i < n; ++i) recurrence(i, i - 1) = recurrence(i - 1, i) = std::sqrt(i / 2.0);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const solver(recurrence);
    std::vector<QuadratureNode> nodes;
    for (int i = 0; i < n; ++i) {
        double const x = solver.eigenvalues()[i], first = solver.eigenvectors()(0, i);
        double const weight = std::sqrt(std::numbers::pi) * first * first;
        nodes.push_back({x, weight, std::log(weight) + x * x});
    }
    return nodes;
}

} // namespace study
