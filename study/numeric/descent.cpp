#include "study/numeric/descent.h"

#include <Eigen/Core>
#include <cmath>

namespace study {

Minimum minimise(std::function<double(std::span<double const>)> const& f, std::vector<double> const& start,
                 int max_iterations)
{
    auto const differences = [&](std::span<double const> at, std::span<double> g) {
        std::vector<double> x(at.begin(), at.end());
        for (std::size_t i = 0; i < x.size(); ++i) {
            double const centre = x[i], step = 1e-5 * (1 + std::abs(centre));
            x[i] = centre + step;
            double const above = f(x);
            x[i] = centre - step;
            g[i] = (above - f(x)) / (2 * step);
            x[i] = centre;
        }
    };
    return minimise(f, differences, start, max_iterations, 1e-10);
}

Minimum minimise(std::function<double(std::span<double const>)> const& f, GradientAt const& gradient_of,
                 std::vector<double> const& start, int max_iterations, double tolerance, double first_step)
{
    using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
    auto const n = Index(start.size());
    auto const value_at = [&](VectorXd const& x) { return f({x.data(), std::size_t(n)}); };
    auto const gradient_at = [&](VectorXd const& x) {
        VectorXd g(n);
        gradient_of({x.data(), std::size_t(n)}, {g.data(), std::size_t(n)});
        return g;
    };

    VectorXd at = VectorXd::Map(start.data(), n), gradient = gradient_at(at);
    MatrixXd inverse = first_step * MatrixXd::Identity(n, n); // of the second derivatives
    Minimum m{start, value_at(at), n == 0};
    for (int iteration = 0; iteration < max_iterations && !m.converged; ++iteration) {
        VectorXd const direction = -(inverse * gradient);
        double const slope = gradient.dot(direction);
        double step = 1, value = 0;
        for (; step > 1e-12; step /= 2) {
            value = value_at(at + step * direction);
            if (value <= m.value + 1e-4 * step * slope) break;
        }
        if (!(step > 1e-12)) {
            m.converged = -slope < 1e3 * tolerance * (1 + std::abs(m.value));
            break;
        }
        m.converged = -slope < tolerance * (1 + std::abs(m.value));
        m.value = value;
        VectorXd const s = step * direction;
        at += s;
        VectorXd const new_gradient = gradient_at(at), y = new_gradient - gradient;
        gradient = new_gradient;
        double const sy = s.dot(y);
        if (!(sy > 1e-14)) {
            inverse = first_step * MatrixXd::Identity(n, n);
            continue;
        }
        VectorXd const hy = inverse * y;
        inverse += (1 + y.dot(hy) / sy) / sy * s * s.transpose() - (hy * s.transpose() + s * hy.transpose()) / sy;
    }
    m.at.assign(at.begin(), at.end());
    return m;
}

} // namespace study
