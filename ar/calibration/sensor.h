#pragma once
// Vignetting, noise and colour of a camera, each from pictures made for it. Bytes become light by a response that
// is known (response.h).

#include "ar/base/photometry.h"

#include <span>
#include <vector>

namespace ar {

struct VignettingFit {
    std::array<double, 3> vignetting{}; ///< as Photometry has it
    double rms = 0;                     ///< relative, of what is left
    std::size_t samples = 0;
};

/// From pictures of something that is evenly bright: a lit wall through paper, an integrating sphere. The
/// brightness of each picture is fitted, too. Clipped pixels do not count.
/// @throws InputError no picture, another type, or hardly a pixel that is not clipped
VignettingFit vignetting_of_flat(std::span<cv::Mat const> rgb, Photometry const& response);

/// One point of the scene seen in two pictures of equal exposure, at different radii.
struct SeenTwice {
    cv::Point2d first_px, second_px;
    std::array<std::uint8_t, 3> first, second; ///< RGB
};
/// From overlapping pictures (a camera that turns; surfaces that are matt): ratios of light at two radii.
/// @throws InputError fewer than 30 pairs that are not clipped, or all at equal radii
VignettingFit vignetting_of_pairs(std::span<SeenTwice const> pairs, cv::Size picture, Photometry const& response);

struct NoiseModel {
    /// Variance of a unit value (1 = Photometry's unit) at the reference exposure: read + photon * unit.
    double read = 0, photon = 0;
    double rms = 0; ///< relative, of the variances about that line
    std::size_t bins = 0;

    double sigma(double unit) const;
    friend bool operator==(NoiseModel const&, NoiseModel const&) = default;
};

/// From pairs of frames of a scene at rest with equal exposure: half the variance of the difference, by
/// brightness, all channels (Healey and Kondepudy 1994, without the part that stays from frame to frame). The
/// variance of rounding to bytes is taken off.
/// @throws InputError an odd number, sizes that differ, no brightnesses to fit
NoiseModel noise_of_pairs(std::span<cv::Mat const> rgb, Photometry const& response);

struct ColourFit {
    cv::Matx33f colour = cv::Matx33f::eye();      ///< Photometry::colour
    double mean_delta_e = 0, largest_delta_e = 0; ///< CIE 1976, of chart white Y = 1 under D65
    std::vector<double> delta_e;                  ///< patch by patch
    double delta_e_before = 0;                    ///< mean without the matrix, brightness fitted alone
};

/// sRGB (linear, BT.709, white = 1) of the 24 patches of a ColorChecker, row by row from dark skin to black
/// (8 bit sRGB as their maker published them for charts made before November 2014).
std::array<cv::Vec3f, 24> const& chart_linear_rgb();

/// From units of patches (linear, by the response, vignetting taken off) and what they should be; least squares.
/// How bright the chart was lit is not the camera's: the brightness that alone explains the patches best is
/// divided out.
/// @throws InputError fewer than six patches, or patches that do not span colours
ColourFit fit_colour(std::span<cv::Vec3f const> camera, std::span<cv::Vec3f const> chart);

/// Means of patches in a picture in linear units. @param centres_px as many as patches; @param half_px half the
/// side of the square that is averaged. @throws InputError a square outside the picture or with clipped pixels
std::vector<cv::Vec3f> patch_units(cv::Mat const& rgb, std::span<cv::Point2d const> centres_px, double half_px,
                                   Photometry const& photometry);

} // namespace ar
