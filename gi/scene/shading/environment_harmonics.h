#pragma once
// Low-frequency part of an environment map: real spherical harmonics, and irradiance computed from them.
//   Ramamoorthi, Hanrahan, "An Efficient Representation for Irradiance Environment Maps", SIGGRAPH 2001, eq. 3-13.
//
// Frame: the polar axis is +Y (up), the azimuth runs from +Z towards +X, counter-clockwise seen from above:
//   cos theta = y, phi = atan2(x, z). The paper's x, y, z are our z, x, y.
// Sign: orthonormal over the sphere, without the phase (-1)^m of Condon and Shortley. Order m > 0 goes with
//   cos(m phi), m < 0 with sin(|m| phi): Y_1,-1 = c x, Y_1,0 = c y, Y_1,1 = c z with c = sqrt(3 / 4 pi).
// Coefficients: L_lm = integral of L(d) Y_lm(d) over the sphere. Irradiance E(n) = sum of A_l L_lm Y_lm(n) with
//   A_l = pi, 2 pi / 3, pi / 4, 0, -pi / 24. It can be slightly negative facing away from a sun-like peak, and 6 %
//   too high facing it (degree 2; 3 % too low with degree 4).

#include "gi/scene/model/world.h"

#include <array>
#include <span>

namespace gi {

struct EnvironmentHarmonics {
    static constexpr int kMostDegree = 4;
    static constexpr std::size_t count(int degree) { return std::size_t((degree + 1) * (degree + 1)); }
    static constexpr std::size_t kMost = (kMostDegree + 1) * (kMostDegree + 1);
    static constexpr std::size_t index(int degree, int order)
    {
        return std::size_t(degree * degree + degree + order);
    }

    int degree = 2;                          ///< 0..kMostDegree
    std::array<dvec3, kMost> coefficients{}; ///< at index(l, m); 0 beyond the degree
    dvec3 squared{0};                        ///< integral of the squared radiance of the whole map, per channel

    /// Fraction of `squared`, over all channels, in degrees up to `up_to`;
    /// 1 = the map has no finer detail, or is black.
    double energy_share(int up_to = kMostDegree) const;
};

/// Returns all Y_lm up to the highest degree. @param direction unit
std::array<double, EnvironmentHarmonics::kMost> spherical_harmonics(dvec3 direction);

/// Projects the bilinearly interpolated map (the one used everywhere; constant between the poles and the centres
/// of the first and last row) by exact integration along rows and quadrature across them (error 1e-10).
/// The map's own rotation and scale are ignored in favour of the arguments.
/// Throws std::invalid_argument for unsupported degrees.
EnvironmentHarmonics project(EnvironmentMap const& map, double rotation_rad, dvec3 scale, int degree = 2);
/// Projects a world's environment with its rotation and scale; all 0 without one.
EnvironmentHarmonics project(World const& world, int degree = 2);

/// Rotates about +Y, counter-clockwise seen from above, as EnvironmentMap::rotation_rad: each pair (m, -m) rotates
/// by m times the angle.
EnvironmentHarmonics rotated(EnvironmentHarmonics const& h, double angle_rad);

/// Irradiance of an unshadowed surface, radiance x sr (W/m2). @param normal unit
dvec3 irradiance(EnvironmentHarmonics const& h, dvec3 normal);
/// Returns the unit normal, to 1 degree, for which the luminance of irradiance() is highest.
dvec3 brightest_normal(EnvironmentHarmonics const& h);

/// Irradiance by numerical integration instead of harmonics, over at least 1024 x 512 points of the map;
/// includes sharp peaks.
std::vector<dvec3> integrate_irradiance(World const& world, std::span<dvec3 const> normals);

} // namespace gi
