#pragma once
// An environment from the shading and the shadows of known surfaces (Sato, Sato and Ikeuchi 2003). Of a matt
// surface of known albedo,
//   pi radiance / albedo = E = sum over directions k of T_k L_k,   T_k = V_k max(0, n.w_k) dw + light by way of
//                                                                  other known surfaces,
// is a linear equation for the radiances L_k >= 0. Many of them (`LightRows`) are solved by least squares with a
// prior of smoothness, which decides where no surface tells: as a normal distribution, it gives the uncertainty
// too. The sun and lamps, which smoothness would blur, are searched for as discs: each that lowers the residuals
// enough is one more unknown with its own exact shadows. Directions that the camera sees itself are known.

#include "ar/light/light_basis.h"

#include <functional>
#include <optional>

namespace ar {

/// Light that the camera sees in a direction of the basis.
struct SeenLight {
    cv::Vec3d radiance{0, 0, 0};
    double share = 0;     ///< of the cell that is seen, 0..1; 0 = none
    bool clipped = false; ///< the radiance is a lower bound
};

/// One equation per sample of a surface. N samples, K directions.
struct LightRows {
    cv::Mat direct;                     ///< N x K, CV_32F: V n.w dw, sr
    std::array<cv::Mat, 3> by_surfaces; ///< N x K, CV_32F per channel: light by way of other surfaces, sr
    std::vector<cv::Vec3d> irradiance;  ///< N: pi radiance / albedo, W/m^2
    std::vector<cv::Vec3d> sigma;       ///< N: its standard deviation
    std::vector<SeenLight> seen;        ///< K, or empty: nothing
    /// V n.w (mean over the disc) of all samples for a disc of light: N values.
    std::function<std::vector<float>(glm::dvec3 towards, double half_angle_rad)> of_disc;
};

struct LightFitSettings {
    /// Prior: the radiance expected in a direction is the mean one above the horizon, and below it that of the
    /// ground: as the camera sees it, else of ground of this albedo, which reflects the upward irradiance.
    double ground_albedo = 0.25;
    /// Prior: standard deviation of the difference of neighbours, relative to the expected light.
    double neighbour_spread = 1.2;
    double mean_spread = 6;  ///< prior: difference from what is expected, relative to it
    double seen_sigma = 0.1; ///< relative, of light seen by the camera: cells are not uniform
    int most_lamps = 3;
    int candidates = 1500;     ///< directions where lamps are searched first
    double least_gain = 0.03;  ///< a lamp must lower the sum of squared residuals by this share
    double least_lit = 0;      ///< and light this share of the samples
    double least_share = 0.02; ///< and give this share of the irradiance of a face turned to it
};

struct FittedLamp {
    glm::dvec3 direction{0, 1, 0};
    double half_angle_rad = 0; ///< of the disc that fits best
    cv::Vec3d irradiance;      ///< of a face turned to it
    cv::Vec3d sigma;           ///< of that, 1 standard deviation
    double gain = 0;           ///< share of the squared residuals that it explained
};

struct LightFit {
    cv::Mat radiance;              ///< K x 1, CV_32FC3: the rest, without lamps
    cv::Mat sigma;                 ///< K x 1, CV_32FC3: 1 standard deviation
    std::vector<float> known;      ///< K: 0 = prior alone, 1 = determined by the picture
    std::vector<FittedLamp> lamps; ///< strongest first
    double residual = 0;           ///< relative RMS of the samples' irradiance, weighted as in the fit
    double residual_without_lamps = 0;
    int outliers = 0;        ///< samples that count less than half, as their residuals are large
    cv::Mat covariance;      ///< (K + lamps) squared, CV_64F, of luminance: for `irradiance_sigma`
    cv::Vec3d mean_radiance; ///< of the prior, above the horizon
};

/// @throws gi::InputError fewer samples than 50, or none with light
LightFit fit_light(LightBasis const& basis, LightRows const& rows, LightFitSettings const& settings = {});

/// The strongest lamp together with those within 8 degrees of it: one light that was fitted by several discs.
std::optional<FittedLamp> dominant_lamp(LightFit const& fit);
/// Lat-long map of the fit: the rest and the lamps as discs, whose light is kept.
cv::Mat map_of(LightBasis const& basis, LightFit const& fit, cv::Size size);
/// Standard deviation of the luminance of a face's irradiance.
double irradiance_sigma(LightBasis const& basis, LightFit const& fit, glm::dvec3 normal);

} // namespace ar
