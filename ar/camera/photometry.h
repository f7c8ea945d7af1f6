#pragma once
// Converts between a camera's bytes and radiance. Pictures are RGB; linear ones are CV_32FC3, in units of radiance
// (W/(m^2 sr), or the scene's own unit, see `radiance_per_unit`).
//   byte = f(unit),   unit = vignetting(r) * colour^-1 * radiance / radiance_per_unit * exposure /
//   reference_exposure, channel by channel (time, gain, white balance)
// Frames of 16 bits have the same response over 0..65535 (`units_of_16_bits`). Linear float frames are radiance:
// neither response nor colour, vignetting and exposure apply; their unit is radiance / radiance_per_unit.
// f: response of each channel (Debevec and Malik 1997), here as its inverse, unit of byte.

#include <array>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

namespace ar {

/// Exposure settings that the camera reports for a frame; 0 = not reported.
struct Exposure {
    double time_s = 0;
    double gain = 0;                    ///< analogue times digital
    double red_gain = 0, blue_gain = 0; ///< white balance, relative to green

    friend bool operator==(Exposure const&, Exposure const&) = default;
};

/// Ratio of exposure (time times gain) to `reference`; 1 if either is unknown.
double relative_exposure(Exposure const& exposure, Exposure const& reference);
/// The same per channel, with the white-balance gains, which change from frame to frame under automatic white
/// balance. A gain that is not reported in either counts as unchanged.
cv::Vec3f relative_gains(Exposure const& exposure, Exposure const& reference);

struct Photometry {
    /// Unit of each byte, per channel: non-decreasing, [0] >= 0. 1 = white paper at the reference
    /// exposure; the largest may be below or above it.
    std::array<std::array<float, 256>, 3> unit_of_byte;
    /// Relative light at radius r (0 at the centre of the picture, 1 at its corners):
    /// 1 + a r^2 + b r^4 + c r^6.
    std::array<double, 3> vignetting{};
    cv::Matx33f colour = cv::Matx33f::eye(); ///< from the camera's linear RGB to linear BT.709 RGB
    double radiance_per_unit = 1;
    Exposure reference;
};

/// Unit of each code of 16 bits, 65536 values: of sRGB bytes the exact curve (IEC 61966-2-1), else linear between
/// the bytes' units (code = 257 byte).
std::shared_ptr<std::vector<float> const> units_of_16_bits(std::array<float, 256> const& unit_of_byte);

/// A camera whose bytes are sRGB (IEC 61966-2-1), without vignetting.
Photometry srgb_photometry();

/// Relative light at the centre of a pixel in a picture of that size; 1 everywhere without vignetting.
double vignetting_at(Photometry const& photometry, cv::Size size, int x, int y);

/// Radiance, CV_32FC3, of a picture: CV_8UC3, CV_16UC3, or CV_32FC3, which is radiance already and not copied. For
/// values of 255 (65535) it is a lower bound (see `is_clipped`).
cv::Mat radiance_of(cv::Mat const& rgb, Photometry const& photometry, Exposure const& exposure = {});
/// CV_8UC3 of CV_32FC3: the byte with the nearest unit. Inverts `radiance_of` for bytes whose unit is
/// different from their neighbours' (for an sRGB camera: all). Non-finite values become 0.
cv::Mat bytes_of(cv::Mat const& radiance, Photometry const& photometry, Exposure const& exposure = {});
/// CV_8UC1: 255 where a channel is 0 or 255 (of 16 bits: 65535), else 0; of CV_32FC3: 0 everywhere.
cv::Mat is_clipped(cv::Mat const& rgb);

} // namespace ar
