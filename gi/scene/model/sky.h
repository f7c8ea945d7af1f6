#pragma once
// A clear sky and its sun: Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999.
//
//   Sky (appendix A.2): for each of Y, x, y, the value in direction (theta, gamma) is
//     zenith * F(theta, gamma) / F(0, theta_sun),  F = (1 + A e^(B / cos theta))
//              (1 + C e^(D gamma) + E cos^2 gamma)
//   with theta from the zenith and gamma from the sun. Zenith and A..E are polynomials of turbidity and theta_sun.
//   Sun (appendix A.1): the sun's radiance outside the atmosphere times the transmittance of air, aerosols, ozone
//   and water vapour along the path through the atmosphere.
//
// Units are photometric: the luminance of an RGB value (linear Rec. 709) is in kcd/m2, and so irradiances come in
// klx. A blue sky has about 3 to 10, a high sun 1.4 million: render with --envmap-scale or --exposure.
//
// Below the horizon is uniform ground that reflects the light of sun and sky according to its albedo.

#include "gi/scene/model/scene.h"

namespace gi {

struct SkyOptions {
    double turbidity = 3;          ///< 2 (very clear) to 10 (hazy); outside, the fit gives negative light
    double sun_elevation_deg = 40; ///< of the sun's centre, 0..90
    double sun_azimuth_deg = 120;  ///< from -Z towards +X, -360..360
    bool sun = true;               ///< the map includes the sun's disc; the sun lights the ground in either case
    vec3 ground_albedo{0.2f};      ///< 0..1
    std::uint32_t width = 1024, height = 512; ///< texels; 8..32768 x 4..16384
};

inline constexpr double kSunRadiusRad = 0.5 * 0.533 * 3.14159265358979323846 / 180;

/// CIE luminance (kcd/m2) and chromaticity.
struct LuminanceXy {
    double luminance, x, y;
};

class Sky {
public:
    /// Throws InputError outside the ranges above.
    explicit Sky(SkyOptions const& options);

    dvec3 to_sun() const { return to_sun_; }
    LuminanceXy zenith() const { return zenith_; }
    /// @param direction unit, above the horizon (y > 0)
    LuminanceXy sky(dvec3 direction) const;
    /// Radiance of sky and ground without the sun: linear Rec. 709, kcd/m2, no negative channels.
    vec3 radiance(dvec3 direction) const;
    /// Radiance of every point of the sun's disc, same units.
    dvec3 sun_radiance() const { return sun_radiance_; }

private:
    /// Perez' five coefficients for one of Y, x, y, and F(0, theta_sun).
    struct Distribution {
        double a, b, c, d, e, at_zenith = 1;
        double value(double cos_theta, double gamma) const;
    };

    dvec3 to_sun_;
    LuminanceXy zenith_;
    Distribution luminance_, x_, y_;
    dvec3 sun_radiance_;
    vec3 ground_{0};
};

/// Returns a map of the whole sphere. Texels of sky and ground are means; those of the sun are chosen such
/// that the bilinear map has the disc's power and horizontal irradiance at every size (with the sun overhead,
/// the irradiance to 0.4 % at 64 x 32). The part of the disc below the horizon is left out.
/// Throws InputError as Sky does.
EnvironmentMap sky_map(SkyOptions const& options);

} // namespace gi
