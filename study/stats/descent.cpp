#include "study/stats/descent.h"

#include "study/stats/matrix.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

double dot(std::vector<double> const& a, std::vector<double> const& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

std::vector<double> product(Matrix const& m, std::vector<double> const& v)
{
    std::vector<double> result(v.size(), 0);
    for (std::size_t r = 0; r < m.rows; ++r)
        for (std::size_t c = 0; c < m.columns; ++c) result[r] += m(r, c) * v[c];
    return result;
}

Matrix identity(std::size_t n)
{
    Matrix m(n, n);
    for (std::size_t i = 0; i < n; ++i) m(i, i) = 1;
    return m;
}

} // namespace

Minimum minimise(std::function<double(std::span<double const>)> const& f, std::vector<double> start,
                 int max_iterations)
{
    std::size_t const n = start.size();
    auto const gradient_at = [&](std::vector<double> x) {
        std::vector<double> g(n);
        for (std::size_t i = 0; i < n; ++i) {
            double const centre = x[i], step = 1e-5 * (1 + std::abs(centre));
            x[i] = centre + step;
            double const above = f(x);
            x[i] = centre - step;
            g[i] = (above - f(x)) / (2 * step);
            x[i] = centre;
        }
        return g;
    };

    Minimum m{std::move(start), 0, n == 0};
    m.value = f(m.at);
    std::vector<double> gradient = gradient_at(m.at);
    Matrix inverse = identity(n); // of the second derivatives
    for (int iteration = 0; iteration < max_iterations && !m.converged; ++iteration) {
        std::vector<double> direction = product(inverse, gradient);
        for (double& d : direction) d = -d;
        double const slope = dot(gradient, direction);
        double step = 1;
        std::vector<double> next;
        double value = 0;
        for (; step > 1e-12; step /= 2) {
            next = m.at;
            for (std::size_t i = 0; i < n; ++i) next[i] += step * direction[i];
            value = f(next);
            if (value <= m.value + 1e-4 * step * slope) break;
        }
        if (!(step > 1e-12)) {
            m.converged = -slope < 1e-7 * (1 + std::abs(m.value));
            break;
        }
        std::vector<double> const new_gradient = gradient_at(next);
        std::vector<double> s(n), y(n);
        for (std::size_t i = 0; i < n; ++i) {
            s[i] = next[i] - m.at[i];
            y[i] = new_gradient[i] - gradient[i];
        }
        m.converged = -slope < 1e-10 * (1 + std::abs(m.value));
        m.at = std::move(next);
        m.value = value;
        gradient = new_gradient;
        double const sy = dot(s, y);
        if (!(sy > 1e-14)) {
            inverse = identity(n);
            continue;
        }
        std::vector<double> const hy = product(inverse, y);
        double const yhy = dot(y, hy);
        for (std::size_t r = 0; r < n; ++r)
            for (std::size_t c = 0; c < n; ++c)
                inverse(r, c) += (1 + yhy / sy) * s[r] * s[c] / sy - (hy[r] * s[c] + s[r] * hy[c]) / sy;
    }
    return m;
}

} // namespace study
