#pragma once
// What bytes of a camera mean as light, from pictures of one scene under several exposures.

#include "ar/calibration/sensor.h"

#include <vector>

namespace ar {

/// Pictures of one scene from one place, nothing but the exposure changed between them.
struct Bracket {
    std::vector<cv::Mat> rgb;        ///< CV_8UC3, of one size
    std::vector<Exposure> exposures; ///< with times; gains too, where they differ
};

/// @throws gi::InputError fewer than two pictures, sizes, types or numbers that differ, exposures without a time,
/// all the same
void check(Bracket const& bracket, std::size_t fewest = 2);

struct ResponseFit {
    /// Response and reference exposure (the middle one of the bracket). Byte 255 of each channel is 1: how
    /// channels compare is the colour matrix's.
    Photometry photometry;
    /// How far exposures disagree after it: RMS of ln(light), per channel.
    std::array<double, 3> disagreement{};
    int levelled = 0; ///< entries of the curve that fell
};

/// The curve of Debevec and Malik 1997 as a power law times the exponential of a polynomial, so that ln(light) of
/// a pixel in two exposures differs by ln of their ratio: least squares over pairs of pixels (as Mitsunaga and
/// Nayar 1999, in logarithms). cv::createCalibrateDebevec has 256 free values and was 9 to 90 % off at byte
/// 250 of drawn brackets where this is 1 % (docs/results).
/// @throws gi::InputError as check(); too few pixels that are neither dark nor bright in two exposures
ResponseFit calibrate_response(Bracket const& bracket);

struct MergedRadiance {
    cv::Mat radiance;           ///< CV_32FC3, as radiance_of gives it
    cv::Mat standard_deviation; ///< CV_32FC1, of green, relative to it; from bytes' rounding and the noise given
    cv::Mat moved;        ///< CV_8UC1, 255 where exposures disagree: things that moved, or lamps that flicker
    int saturated = 0;    ///< pixels that are white in the shortest exposure: their light is a lower bound
    int dark = 0;         ///< pixels that are black in the longest: an upper bound
    int inconsistent = 0; ///< pixels of `moved`
};

struct MergeOptions {
    NoiseModel noise{1e-5, 1e-4}; ///< of the sensor
    double moved_sigmas = 5;      ///< how many sigmas apart exposures may be
};

/// Light of a bracket with a known response: the mean of what the exposures say, weighted by the inverse of their
/// variance (noise of the sensor, and rounding times the slope of the response; bytes that noise may have clipped
/// do not count). Vignetting and colour of the photometry are applied. Where exposures disagree, that one alone
/// counts which has the least variance.
/// @throws gi::InputError as check()
MergedRadiance merge(Bracket const& bracket, Photometry const& photometry, MergeOptions const& options = {});

} // namespace ar
