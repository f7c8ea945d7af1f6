#pragma once
// Vignetting, noise and colour of a camera, each from pictures made for it. Bytes become light by a response that
// is known (response.h).

#include "ar/camera/camera_model.h"
#include "ar/camera/photometry.h"

#include <span>
#include <vector>

namespace ar {

struct VignettingFit {
    std::array<double, 3> vignetting{}; ///< as Photometry has it
    double rms = 0;                     ///< relative to the centre: of the samples about the curve
    /// Samples: radius (1 at the corners) and light relative to the centre, means of 24 x 24 parts of the picture.
    std::vector<cv::Point2d> points;
};

/// From pictures of something that is evenly bright: a lit wall through paper, an integrating sphere. The
/// brightness of each picture is fitted, too. Clipped pixels do not count.
/// @throws gi::InputError no picture, another type, fewer than 100 parts that are not clipped, or none beyond a
/// radius of 0.8
VignettingFit vignetting_of_flat(std::span<cv::Mat const> rgb, Photometry const& response);

struct NoiseModel {
    /// Variance of a unit value (1 = Photometry's unit) at the reference exposure: read + photon * unit.
    double read = 0, photon = 0;

    double sigma(double unit) const;
    friend bool operator==(NoiseModel const&, NoiseModel const&) = default;
};

struct NoiseFit {
    NoiseModel noise;
    double rms = 0;                  ///< relative: of the variances about the line
    std::vector<cv::Point2d> points; ///< unit and variance, by brightness
};

/// From pairs of frames of a scene at rest with equal exposure: half the variance of the difference, by
/// brightness, all channels (Healey and Kondepudy 1994, without the part that stays from frame to frame). The
/// variance of rounding to bytes is taken off.
/// @throws gi::InputError an odd number, sizes that differ, a pair that does not differ, no brightnesses to fit
NoiseFit noise_of_pairs(std::span<cv::Mat const> rgb, Photometry const& response);

struct ColourFit {
    cv::Matx33f colour = cv::Matx33f::eye();      ///< Photometry::colour
    double mean_delta_e = 0, largest_delta_e = 0; ///< CIE 1976, of chart white Y = 1 under D65
    std::vector<double> delta_e;                  ///< patch by patch
    double delta_e_before = 0;                    ///< mean without the matrix, brightness fitted alone
    double brightness = 1; ///< of the chart: times colour * unit it is what the patches should be
};

/// sRGB (linear, BT.709, white = 1) of the 24 patches of a ColorChecker, row by row from dark skin to black
/// (8 bit sRGB as their maker published them for charts made before November 2014).
std::array<cv::Vec3f, 24> const& chart_linear_rgb();

/// From units of patches (linear, by the response, vignetting taken off) and what they should be; least squares.
/// How bright the chart was lit is not the camera's: the brightness that alone explains the patches best is
/// divided out.
/// @throws gi::InputError fewer than six patches, patches that do not span colours, or whose mean ΔE stays above
/// 10
ColourFit fit_colour(std::span<cv::Vec3f const> camera, std::span<cv::Vec3f const> chart);

/// Where the 24 patches of a ColorChecker are seen: flat, so by perspective and the lens.
/// @param corners_px centres of the four corner patches: dark skin (1), bluish green (6), black (24), white (19)
/// @throws gi::InputError corners that are not a convex quadrilateral, or of which the lens sees none
std::vector<cv::Point2d> chart_centres(std::array<cv::Point2d, 4> const& corners_px, CameraModel const& camera);

/// Means of patches in a picture in linear units. @param centres_px as many as patches; @param half_px half the
/// side of the square that is averaged. @throws gi::InputError a square outside the picture or with clipped pixels
std::vector<cv::Vec3f> patch_units(cv::Mat const& rgb, std::span<cv::Point2d const> centres_px, double half_px,
                                   Photometry const& photometry);

} // namespace ar
