#include "study/stats/gauss_hermite.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace study {

std::vector<QuadratureNode> gauss_hermite(int n)
{
    // Golub & Welsch 1969: nodes are eigenvalues of the matrix of the recurrence.
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
