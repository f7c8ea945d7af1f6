#pragma once
// Estimates a camera's response curve (byte to light) from pictures of one scene under several exposures.

#include "ar/calibration/sensor.h"

#include <vector>

namespace ar {

/// Pictures of one static scene from one place that differ only in exposure.
struct Bracket {
    std::vector<cv::Mat> rgb;        ///< CV_8UC3, all of the same size
    std::vector<Exposure> exposures; ///< times, and gains if they differ
};

/// @throws gi::InputError fewer than `fewest` pictures, sizes, types or counts that differ, exposures without a
/// time, or all exposures equal
void check(Bracket const& bracket, std::size_t fewest = 2);

struct ResponseFit {
    /// Response and reference exposure (the middle one of the bracket). Byte 255 of each channel is 1; the colour
    /// matrix sets the channels' relative scale.
    Photometry photometry;
    /// Remaining disagreement of the exposures under the fitted response: RMS of ln(light), per channel.
    std::array<double, 3> disagreement{};
    int levelled = 0; ///< decreasing entries of the curve that were levelled
};

/// Fits the curve of Debevec and Malik 1997 as a power law times the exponential of a polynomial, so that
/// ln(light) of a pixel in two exposures differs by ln of the exposure ratio: least squares over pairs of pixels
/// (as Mitsunaga and Nayar 1999, in logarithms). cv::createCalibrateDebevec has 256 free values and was 9 to 90 %
/// off at byte 250 of synthetic brackets, where this fit is 1 % off (docs/decisions/markers.md).
/// @throws gi::InputError as check(), or too few pixels that are neither dark nor bright in two exposures
ResponseFit calibrate_response(Bracket const& bracket);

struct MergedRadiance {
    cv::Mat radiance;           ///< CV_32FC3, as radiance_of gives it
    cv::Mat standard_deviation; ///< CV_32FC1, green, relative; from quantisation and sensor noise
    cv::Mat moved;        ///< CV_8UC1, 255 where exposures disagree: objects that moved, or lights that flicker
    int saturated = 0;    ///< pixels that are white in the shortest exposure: their light is a lower bound
    int dark = 0;         ///< pixels that are black in the longest exposure: their light is an upper bound
    int inconsistent = 0; ///< number of pixels marked in `moved`
};

struct MergeOptions {
    NoiseModel noise{1e-5, 1e-4}; ///< of the sensor
    double moved_sigmas = 5;      ///< exposures may differ by this many sigmas before they count as inconsistent
};

/// Radiance from a bracket with a known response: the mean over the exposures, weighted by inverse variance
/// (sensor noise, and quantisation times the slope of the response; bytes that noise may have clipped do not
/// count). Vignetting and colour of the photometry are applied. Where exposures disagree, only the one with the
/// smallest variance counts.
/// @throws gi::InputError as check()
MergedRadiance merge(Bracket const& bracket, Photometry const& photometry, MergeOptions const& options = {});

} // namespace ar
