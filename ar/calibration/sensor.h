#pragma once
// Estimates a camera's vignetting, noise and colour matrix, each from pictures taken for the purpose. Bytes are
// converted to light by a known response (response.h).

#include "ar/camera/camera_model.h"
#include "ar/camera/photometry.h"

#include <span>
#include <vector>

namespace ar {

struct VignettingFit {
    std::array<double, 3> vignetting{}; ///< coefficients as in Photometry
    double rms = 0;                     ///< RMS error of the samples about the curve, relative to the centre
    /// Samples: radius (1 at the corners) and light relative to the centre, as means over a 24 x 24 grid of cells.
    std::vector<cv::Point2d> points;
};

/// Fits vignetting to pictures of a uniformly bright target: a lit wall through paper, an integrating sphere. The
/// brightness of each picture is fitted, too. Clipped pixels do not count.
/// @throws gi::InputError no picture, another type, fewer than 100 unclipped cells, or none beyond a radius of 0.8
VignettingFit vignetting_of_flat(std::span<cv::Mat const> rgb, Photometry const& response);

struct NoiseModel {
    /// Variance of a unit value (1 = Photometry's unit) at the reference exposure: read + photon * unit.
    double read = 0, photon = 0;

    double sigma(double unit) const;
    friend bool operator==(NoiseModel const&, NoiseModel const&) = default;
};

struct NoiseFit {
    NoiseModel noise;
    double rms = 0;                  ///< relative RMS error of the variances about the line
    std::vector<cv::Point2d> points; ///< unit and variance, ordered by brightness
};

/// Fits noise to pairs of frames of a static scene with equal exposure: half the variance of the difference, by
/// brightness, all channels (Healey and Kondepudy 1994, without fixed-pattern noise). The quantisation variance of
/// bytes is subtracted.
/// @throws gi::InputError an odd number of frames, sizes that differ, an identical pair, no brightnesses to fit
NoiseFit noise_of_pairs(std::span<cv::Mat const> rgb, Photometry const& response);

struct ColourFit {
    cv::Matx33f colour = cv::Matx33f::eye();      ///< Photometry::colour
    double mean_delta_e = 0, largest_delta_e = 0; ///< CIE 1976, of chart white Y = 1 under D65
    std::vector<double> delta_e;                  ///< per patch
    double delta_e_before = 0;                    ///< mean without the matrix, brightness fitted alone
    double brightness = 1; ///< of the chart: times colour * unit it should give the patches' true values
};

/// sRGB (linear, BT.709, white = 1) of the 24 patches of a ColorChecker, row by row from dark skin to black
/// (8 bit sRGB as their maker published them for charts made before November 2014).
std::array<cv::Vec3f, 24> const& chart_linear_rgb();

/// Least-squares fit from the patches' units (linear, by the response, vignetting corrected) to their true values.
/// How brightly the chart was lit is no property of the camera, so the best-fitting
/// overall brightness is divided out.
/// @throws gi::InputError fewer than six patches, patches that do not span colours,
/// or a mean ΔE that stays above 10
ColourFit fit_colour(std::span<cv::Vec3f const> camera, std::span<cv::Vec3f const> chart);

/// Where the centres of the 24 patches of a flat ColorChecker are in a picture, px, row by row from dark skin (1) to
/// black (24). The lens distortion is removed from the four corners, a homography places the other patches, and the
/// distortion is applied again.
/// @param corners_px  centres of the corner patches in order around the chart: dark skin (1), bluish green (6),
/// black (24), white (19)
/// @throws gi::InputError corners that, without distortion, form no convex quadrilateral,
/// or a patch that the lens cannot see
std::vector<cv::Point2d> chart_centres(std::array<cv::Point2d, 4> const& corners_px, CameraModel const& camera);

/// Mean linear units of each patch of a picture. @param centres_px one per patch; @param half_px half the side
/// of the averaged square. @throws gi::InputError a square outside the picture or with clipped pixels
std::vector<cv::Vec3f> patch_units(cv::Mat const& rgb, std::span<cv::Point2d const> centres_px, double half_px,
                                   Photometry const& photometry);

} // namespace ar
