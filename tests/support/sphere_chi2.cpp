#include "tests/support/sphere_chi2.h"

#include "tests/support/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace gi::test {
namespace {

constexpr double kTwoPi = 6.283185307179586477;
constexpr int kDepth = 8;

/// Part of a bin, in t and azimuth.
struct Cell {
    double t, azimuth, height, width;
};

struct Integrator {
    SphereBins const& bins;
    std::function<double(vec3)> const& f;

    double rule(Cell const& c) const
    {
        constexpr std::array<double, 4> kNode{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                              0.8611363115940526};
        constexpr std::array<double, 4> kWeight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                                0.3478548451374538};
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            double const t = c.t + 0.5 * (1 + kNode[i]) * c.height;
            double row = 0;
            for (std::size_t j = 0; j < 4; ++j)
                row += kWeight[j] * f(bins.direction(t, c.azimuth + 0.5 * (1 + kNode[j]) * c.width));
            sum += kWeight[i] * row * bins.jacobian(t);
        }
        return 0.25 * sum * c.height * c.width;
    }

    double refine(Cell const& c, double whole, double tolerance, int depth) const
    {
        double const h = 0.5 * c.height, w = 0.5 * c.width;
        std::array<Cell, 4> const parts{Cell{c.t, c.azimuth, h, w}, Cell{c.t + h, c.azimuth, h, w},
                                        Cell{c.t, c.azimuth + w, h, w}, Cell{c.t + h, c.azimuth + w, h, w}};
        std::array<double, 4> value;
        std::transform(parts.begin(), parts.end(), value.begin(), [this](Cell const& part) { return rule(part); });
        double const sum = std::accumulate(value.begin(), value.end(), 0.0);
        if (depth == 0 || !(std::abs(sum - whole) > tolerance)) return sum; // also NaN
        double refined = 0;
        for (std::size_t i = 0; i < 4; ++i) refined += refine(parts[i], value[i], 0.5 * tolerance, depth - 1);
        return refined;
    }
};

} // namespace

std::size_t SphereBins::bin_of(vec3 d) const
{
    dvec3 const v(d);
    double const x = glm::dot(v, dvec3(frame.tangent)), y = glm::dot(v, dvec3(frame.bitangent));
    double const polar = std::atan2(std::hypot(x, y), glm::dot(v, dvec3(frame.normal)));
    double const t = std::pow(polar / (0.5 * kTwoPi), 1.0 / focus);
    double const turn = std::atan2(y, x) / kTwoPi;
    int const row = std::clamp(int(t * rows), 0, rows - 1);
    int const column = std::clamp(int((turn < 0 ? turn + 1 : turn) * columns), 0, columns - 1);
    return std::size_t(row * columns + column);
}

vec3 SphereBins::direction(double t, double azimuth) const
{
    double const polar = 0.5 * kTwoPi * std::pow(t, focus), turn = kTwoPi * azimuth;
    return vec3(std::sin(polar) *
                    (std::cos(turn) * dvec3(frame.tangent) + std::sin(turn) * dvec3(frame.bitangent)) +
                std::cos(polar) * dvec3(frame.normal));
}

double SphereBins::jacobian(double t) const
{
    double const polar = 0.5 * kTwoPi * std::pow(t, focus);
    return std::sin(polar) * 0.5 * kTwoPi * focus * std::pow(t, focus - 1) * kTwoPi;
}

std::vector<double> integrate(SphereBins const& bins, std::function<double(vec3)> const& f, double tolerance)
{
    Integrator const integrator{bins, f};
    double const height = 1.0 / bins.rows, width = 1.0 / bins.columns;
    std::vector<double> result;
    for (int row = 0; row < bins.rows; ++row)
        for (int column = 0; column < bins.columns; ++column) {
            Cell const cell{row * height, column * width, height, width};
            result.push_back(integrator.refine(cell, integrator.rule(cell), tolerance, kDepth));
        }
    return result;
}

double integrate_all(SphereBins const& bins, std::function<double(vec3)> const& f, double tolerance)
{
    std::vector<double> const parts = integrate(bins, f, tolerance);
    return std::accumulate(parts.begin(), parts.end(), 0.0);
}

SphereChi2 test_sampler(SphereBins const& bins, std::function<std::optional<vec3>()> const& sample,
                        std::function<double(vec3)> const& pdf, int samples)
{
    // A tenth of a sample per bin is far below the noise.
    std::vector<double> expected = integrate(bins, pdf, 0.1 / samples);
    std::vector<double> observed(expected.size() + 1, 0.0);
    for (int i = 0; i < samples; ++i) {
        std::optional<vec3> const direction = sample();
        ++observed[direction ? bins.bin_of(*direction) : expected.size()];
    }
    double const integral = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (double& e : expected) e *= samples;
    // Less than two samples is what the integration may have missed.
    double const missing = (1 - integral) * samples;
    expected.push_back(missing > 2 || observed.back() > 0 ? std::max(missing, 0.0) : 0.0);
    return {chi_square_p(observed, expected), integral, observed.back() / samples};
}

} // namespace gi::test
