#pragma once
// A camera's unprocessed frame with its timestamps.

#include "ar/camera/photometry.h"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

namespace ar {

enum class PixelFormat {
    rgb8,
    bgr8,
    gray8,
    nv12,
    yuyv,
    mjpeg,
    rgb16,     ///< 0..65535, encoded as bytes are: by the camera's response, or sRGB
    rgb_linear ///< float, radiance (ar/camera/photometry.h); values beyond 1 and below 0 are kept
};
std::string name_of(PixelFormat format);

/// Where `captured_s` comes from, best first.
enum class TimestampOrigin {
    sensor,  ///< the sensor's clock, start of the exposure
    driver,  ///< the driver's clock, end of the transfer
    file,    ///< recorded
    arrival, ///< time of arrival in the program: the frame is older by an unknown time
};
std::string name_of(TimestampOrigin origin);

struct Frame {
    std::uint64_t sequence = 0; ///< the source's number; gaps are frames lost before arrival
    double captured_s = 0;      ///< steady clock of this machine (std::chrono::steady_clock), seconds
    double arrived_s = 0;       ///< time of delivery on the same clock
    TimestampOrigin origin = TimestampOrigin::arrival;
    Exposure exposure;
    PixelFormat format = PixelFormat::rgb8;
    glm::ivec2 size_px{0};
    /// Pixel data: rgb8, bgr8 (CV_8UC3); gray8 (CV_8UC1); yuyv (CV_8UC2); mjpeg (1 x n, CV_8UC1); rgb16
    /// (CV_16UC3); rgb_linear (CV_32FC3); nv12: Y in planes[0] (CV_8UC1), UV in planes[1] (CV_8UC2, half the
    /// size). Rows may be padded. Read only.
    std::array<cv::Mat, 2> planes;
    /// Keeps the planes' memory from being reused; null if the planes own it.
    std::shared_ptr<void const> owner;
};

/// RGB with all bits of the frame: CV_8UC3, of rgb16 CV_16UC3, of rgb_linear CV_32FC3. As `rgb_of` otherwise.
cv::Mat picture_of(Frame const& frame);
/// The same picture with 8 bits, CV_8UC3; not copied if it has them. 16 bits are rounded, linear radiance becomes
/// sRGB with 1 as white.
cv::Mat eight_bits_of(cv::Mat const& picture);

/// Converts to RGB, CV_8UC3 (`eight_bits_of`), of the frame's size.
/// RGB frames are not copied (the result is valid as long as the frame). YUV is BT.601 with limited range.
/// @throws gi::InputError JPEG that cannot be decoded or has another size
cv::Mat rgb_of(Frame const& frame);
/// Converts to luma, CV_8UC1; not copied if the format has a luma plane.
cv::Mat gray_of(Frame const& frame);

} // namespace ar
