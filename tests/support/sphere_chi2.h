#pragma once
// Bins over the sphere of directions: integrals of a density over each, and the chi-square test of a sampler
// against its density (after Mitsuba's chi2.py).

#include "gi/core/math.h"

#include <functional>
#include <optional>
#include <vector>

namespace gi::test {

/// rows x columns bins, equal steps of t and of the azimuth about frame.normal; polar angle = pi * t^focus.
/// Bin (row, column) is number row * columns + column.
struct SphereBins {
    Frame frame = Frame::about({0, 0, 1});
    int rows = 32, columns = 64;
    int focus = 1; ///< above 1 the bins shrink towards the axis, for narrow lobes

    std::size_t bin_of(vec3 direction) const;
    /// @param t, azimuth  in [0, 1]
    vec3 direction(double t, double azimuth) const;
    /// Solid angle per unit of t and azimuth.
    double jacobian(double t) const;
};

/// Integral of f over each bin by adaptive subdivision of 4 x 4 Gauss-Legendre points. These lie inside the cells,
/// so that a jump at an edge (the horizon) does no harm. @param tolerance error that is accepted per bin
std::vector<double> integrate(SphereBins const& bins, std::function<double(vec3)> const& f, double tolerance);
/// The sum over all bins.
double integrate_all(SphereBins const& bins, std::function<double(vec3)> const& f, double tolerance);

struct SphereChi2 {
    double p; ///< of observing what was drawn; what was rejected is one more bin, which expects 1 - integral
    double integral; ///< of the density
    double rejected; ///< share of the samples
};

/// @param sample draws a direction, nullopt = none (rejected, or through a delta lobe)
SphereChi2 test_sampler(SphereBins const& bins, std::function<std::optional<vec3>()> const& sample,
                        std::function<double(vec3)> const& pdf, int samples);

} // namespace gi::test
