#include "gi/scene/model/sky.h"

#include "gi/core/error.h"
#include "gi/scene/model/spectrum.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace gi {
namespace {

void check(bool good, std::string const& problem, char const* why, char const* suggestion)
{
    if (!good) throw InputError(problem, why, suggestion);
}

void check(SkyOptions const& o)
{
    check(o.turbidity >= 2 && o.turbidity <= 10, fmt::format("the sky's turbidity is {}", o.turbidity),
          "the model fits clear to hazy skies and gives negative light otherwise",
          "choose 2 (very clear) to 10 (hazy)");
    check(o.sun_elevation_deg >= 0 && o.sun_elevation_deg <= 90,
          fmt::format("the sun's elevation is {} degrees", o.sun_elevation_deg), "the model has no night sky",
          "choose 0 (at the horizon) to 90 (overhead)");
    check(o.sun_azimuth_deg >= -360 && o.sun_azimuth_deg <= 360,
          fmt::format("the sun's azimuth is {} degrees", o.sun_azimuth_deg), "it is more than a full turn",
          "choose -360 to 360, from -Z towards +X");
    for (int c = 0; c < 3; ++c)
        check(o.ground_albedo[c] >= 0 && o.ground_albedo[c] <= 1,
              fmt::format("the ground albedo is {}", o.ground_albedo[c]), "it would reflect more than it receives",
              "choose 0 to 1");
    check(o.width >= 8 && o.width <= 32768 && o.height >= 4 && o.height <= 16384,
          fmt::format("the sky map has {} x {} texels", o.width, o.height), "8 x 4 to 32768 x 16384 work",
          "choose 1024x512");
}

/// Desaturates a colour towards grey of the same luminance until no channel is negative.
dvec3 into_gamut(dvec3 c)
{
    double const grey = glm::dot(c, dvec3{0.2126, 0.7152, 0.0722}), least = std::min({c.x, c.y, c.z});
    return least < 0 ? glm::max(grey + (c - grey) * (grey / (grey - least)), dvec3{0}) : c;
}

dvec3 to_rec709(LuminanceXy const& v)
{
    dvec3 const xyz{v.x / v.y, 1, (1 - v.x - v.y) / v.y};
    return into_gamut(xyz_to_rec709(v.luminance * xyz));
}

// Solar radiance outside the atmosphere, W / (cm2 um sr) (the paper's table 2),
// and absorption of ozone and water vapour, 1/cm.
constexpr std::array kSun{1655.9,  1623.37, 2112.75, 2588.82, 2582.91, 2423.23, 2676.05, 2965.83, 3054.54, 3005.75,
                          3066.37, 2883.04, 2871.21, 2782.5,  2710.06, 2723.36, 2636.13, 2550.38, 2506.02, 2531.16,
                          2535.59, 2513.42, 2463.15, 2417.32, 2368.53, 2321.21, 2282.77, 2233.98, 2197.02, 2152.67,
                          2109.79, 2072.83, 2024.04, 1987.08, 1942.72, 1907.24, 1862.89, 1825.92};
constexpr std::array kOzone{0.003, 0.006, 0.009, 0.014, 0.021, 0.030, 0.040, 0.048, 0.063, 0.075, 0.085,
                            0.103, 0.120, 0.120, 0.115, 0.125, 0.120, 0.105, 0.090, 0.079, 0.067, 0.057,
                            0.048, 0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009};
constexpr std::array kVapour{0.0, 0.016, 0.024, 0.0125, 1.0, 0.87, 0.061, 0.001};

/// Preetham et al., appendix A.1, with 0.35 cm of ozone, 2 cm of water and an aerosol exponent of 1.3. Oxygen
/// is omitted because it absorbs only beyond 750 nm.
double transmittance(double nm, double turbidity, double air_mass)
{
    Spectrum const ozone{450, 10, kOzone}, vapour{680, 10, kVapour};
    double const um = 1e-3 * nm, beta = 0.04608 * turbidity - 0.04586;
    double const o = nm > 440 ? ozone.at(nm) * std::min(1.0, 0.1 * (nm - 440)) : 0.0;
    double const water = 2 * vapour.at(nm) * air_mass;
    return std::exp(-air_mass * (0.008735 * std::pow(um, -4.08) + beta * std::pow(um, -1.3) + 0.35 * o) -
                    0.2385 * water / std::pow(1 + 20.07 * water, 0.45));
}

dvec3 attenuated_sun(double turbidity, double theta)
{
    double const degrees = theta * 180 / kPiD;
    double const air_mass = 1 / (std::cos(theta) + 0.15 * std::pow(93.885 - degrees, -1.253));
    Spectrum const sun{380, 10, kSun};
    dvec3 xyz{0};
    constexpr double kStep = 5, kPerNm = 1e4 * 1e-3, kEfficacy = 683 * 1e-3; // to m2 and nm; to klm
    for (double nm = 380; nm <= 750; nm += kStep)
        xyz += kStep * kPerNm * kEfficacy * sun.at(nm) * transmittance(nm, turbidity, air_mass) * cie_observer(nm);
    return into_gamut(xyz_to_rec709(xyz));
}

} // namespace

double Sky::Distribution::value(double cos_theta, double gamma) const
{
    double const cos_gamma = std::cos(gamma);
    return (1 + a * std::exp(b / std::max(cos_theta, 1e-6))) *
           (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma) / at_zenith;
}

Sky::Sky(SkyOptions const& o)
{
    check(o);
    double const t = o.turbidity, elevation = glm::radians(o.sun_elevation_deg), s = kPiD / 2 - elevation;
    double const azimuth = glm::radians(o.sun_azimuth_deg);
    to_sun_ = {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
               -std::cos(elevation) * std::cos(azimuth)};
    // Appendix A.2.
    luminance_ = {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                  -0.0670 * t + 0.3703};
    x_ = {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
          -0.0033 * t + 0.0452};
    y_ = {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
          -0.0109 * t + 0.0529};
    double const chi = (4.0 / 9 - t / 120) * (kPiD - 2 * s);
    zenith_.luminance = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
    zenith_.x = ((0.00166 * s - 0.00375) * s + 0.00209) * s * t * t +
                (((-0.02903 * s + 0.06377) * s - 0.03202) * s + 0.00394) * t +
                ((0.11693 * s - 0.21196) * s + 0.06052) * s + 0.25886;
    zenith_.y = ((0.00275 * s - 0.00610) * s + 0.00317) * s * t * t +
                (((-0.04214 * s + 0.08970) * s - 0.04153) * s + 0.00516) * t +
                ((0.15346 * s - 0.26756) * s + 0.06670) * s + 0.26688;
    for (Distribution* d : {&luminance_, &x_, &y_}) d->at_zenith = d->value(1, s);
    sun_radiance_ = attenuated_sun(t, s);

    // Midpoint rule on cells of equal projected solid angle.
    constexpr int kRings = 64, kSectors = 128;
    double const solid_angle = 2 * kPiD * (1 - std::cos(kSunRadiusRad));
    dvec3 irradiance = sun_radiance_ * solid_angle * std::sin(elevation);
    for (int i = 0; i < kRings; ++i)
        for (int k = 0; k < kSectors; ++k) {
            double const sine = std::sqrt((i + 0.5) / kRings), phi = 2 * kPiD * (k + 0.5) / kSectors;
            dvec3 const d{sine * std::sin(phi), std::sqrt(1 - sine * sine), -sine * std::cos(phi)};
            irradiance += to_rec709(sky(d)) * (kPiD / (kRings * kSectors));
        }
    ground_ = vec3(dvec3(o.ground_albedo) * irradiance / kPiD);
}

LuminanceXy Sky::sky(dvec3 direction) const
{
    double const gamma = std::acos(glm::clamp(glm::dot(direction, to_sun_), -1.0, 1.0));
    auto const at = [&](double zenith, Distribution const& d) { return zenith * d.value(direction.y, gamma); };
    return {at(zenith_.luminance, luminance_), at(zenith_.x, x_), at(zenith_.y, y_)};
}

vec3 Sky::radiance(dvec3 direction) const { return direction.y > 0 ? vec3(to_rec709(sky(direction))) : ground_; }

} // namespace gi
