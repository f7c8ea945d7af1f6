#pragma once
// Between a camera's bytes and radiance. Pictures are RGB; linear ones are CV_32FC3, in units of radiance (W/(m^2
// sr), or whatever unit the scene has: `radiance_per_unit` says it).
//   byte = f(unit),   unit = vignetting(r) * colour^-1 * radiance / radiance_per_unit * exposure /
//   reference_exposure, channel by channel (time, gain, white balance)
// f: response of each channel (Debevec and Malik 1997), here as its inverse, unit of byte.

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace ar {

/// What the camera says of a frame; 0 = it does not say.
struct Exposure {
    double time_s = 0;
    double gain = 0;                    ///< analogue times digital
    double red_gain = 0, blue_gain = 0; ///< white balance, against green

    friend bool operator==(Exposure const&, Exposure const&) = default;
};

/// How much more light reaches the bytes than at `reference`: time times gain. 1 where either is unknown.
double relative_exposure(Exposure const& exposure, Exposure const& reference);
/// The same for each channel: with the gains of white balance, which cameras that balance by themselves change
/// from frame to frame. A gain that either does not say counts as unchanged.
cv::Vec3f relative_gains(Exposure const& exposure, Exposure const& reference);

struct Photometry {
    /// Unit of each byte, channel by channel: never falling, [0] >= 0. 1 = what white paper under the reference
    /// exposure would be; the largest may be below or above it.
    std::array<std::array<float, 256>, 3> unit_of_byte;
    /// What is left of the light at the radius r (0 at the centre of the picture, 1 at its corners):
    /// 1 + a r^2 + b r^4 + c r^6.
    std::array<double, 3> vignetting{};
    cv::Matx33f colour = cv::Matx33f::eye(); ///< linear RGB (of BT.709) of the camera's linear RGB
    double radiance_per_unit = 1;
    Exposure reference;
};

/// A camera whose bytes are sRGB (IEC 61966-2-1), without vignetting.
Photometry srgb_photometry();

/// What is left of the light at the centre of a pixel of a picture of that size; 1 everywhere without vignetting.
double vignetting_at(Photometry const& photometry, cv::Size size, int x, int y);

/// CV_32FC3 of CV_8UC3. Bytes of 255 become what 255 means: the light may have been brighter (see `is_clipped`).
cv::Mat radiance_of(cv::Mat const& rgb, Photometry const& photometry, Exposure const& exposure = {});
/// CV_8UC3 of CV_32FC3: the byte whose unit is nearest. The inverse of `radiance_of` for bytes whose unit is
/// unlike their neighbours' (for an sRGB camera: all). Not finite: 0.
cv::Mat bytes_of(cv::Mat const& radiance, Photometry const& photometry, Exposure const& exposure = {});
/// CV_8UC1: 255 where a channel is 0 or 255, else 0.
cv::Mat is_clipped(cv::Mat const& rgb);

} // namespace ar
