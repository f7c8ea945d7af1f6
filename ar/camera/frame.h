#pragma once
// A camera's frame as it came, and when.

#include "ar/camera/photometry.h"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

namespace ar {

enum class PixelFormat { rgb8, bgr8, gray8, nv12, yuyv, mjpeg };
std::string name_of(PixelFormat format);

/// Where `captured_s` comes from, best first.
enum class TimestampOrigin {
    sensor,  ///< the sensor's clock, start of the exposure
    driver,  ///< the driver's, end of the transfer
    file,    ///< recorded
    arrival, ///< when it came here: the frame is older by an unknown time
};
std::string name_of(TimestampOrigin origin);

struct Frame {
    std::uint64_t sequence = 0; ///< the source's number; a gap is frames that were lost before they came here
    double captured_s = 0;      ///< steady clock of this machine (std::chrono::steady_clock), seconds
    double arrived_s = 0;       ///< the same clock, when it was handed over
    TimestampOrigin origin = TimestampOrigin::arrival;
    Exposure exposure;
    PixelFormat format = PixelFormat::rgb8;
    glm::ivec2 size_px{0};
    /// The bytes: rgb8, bgr8 (CV_8UC3); gray8 (CV_8UC1); yuyv (CV_8UC2); mjpeg (1 x n, CV_8UC1); nv12: Y in
    /// planes[0] (CV_8UC1), UV in planes[1] (CV_8UC2, half the size). Rows may have gaps between them. Read only.
    std::array<cv::Mat, 2> planes;
    /// Keeps the memory of the planes from being used again; null where they own it.
    std::shared_ptr<void const> owner;
};

/// RGB, CV_8UC3, of the frame's size. What is RGB already is not copied (then it lives as long as the frame). YUV
/// is BT.601 of limited range; JPEG that cannot be decoded, or has another size, is @throws gi::InputError
cv::Mat rgb_of(Frame const& frame);
/// CV_8UC1, not copied where the format has a plane of luma.
cv::Mat gray_of(Frame const& frame);

} // namespace ar
