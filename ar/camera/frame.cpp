#include "ar/camera/frame.h"

#include "gi/core/error.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

cv::Mat decoded(Frame const& f, int mode)
{
    // OpenCV would try every decoder on other data, and its DICOM decoder terminates the process on bad bytes.
    cv::Mat const& bytes = f.planes[0];
    bool const is_jpeg = bytes.type() == CV_8UC1 && bytes.isContinuous() && bytes.total() > 3 &&
                         bytes.data[0] == 0xff && bytes.data[1] == 0xd8 && bytes.data[2] == 0xff;
    cv::Mat const picture = is_jpeg ? cv::imdecode(bytes, mode) : cv::Mat();
    if (picture.empty())
        throw gi::InputError(fmt::format("frame {} is no JPEG that can be decoded", f.sequence),
                             "it has no pixels", "count it as lost");
    if (picture.cols != f.size_px.x || picture.rows != f.size_px.y)
        throw gi::InputError(fmt::format("frame {} has {} x {} pixels in place of {} x {}", f.sequence,
                                         picture.cols, picture.rows, f.size_px.x, f.size_px.y),
                             "the calibration is for another size", "count it as lost");
    return picture;
}

} // namespace

std::string name_of(PixelFormat format)
{
    constexpr std::array<char const*, 8> names{"rgb8", "bgr8",  "gray8", "nv12",
                                               "yuyv", "mjpeg", "rgb16", "rgb_linear"};
    return names[std::size_t(format)];
}

std::string name_of(TimestampOrigin origin)
{
    constexpr std::array<char const*, 4> names{"sensor", "driver", "file", "arrival"};
    return names[std::size_t(origin)];
}

cv::Mat eight_bits_of(cv::Mat const& picture)
{
    if (picture.depth() == CV_8U) return picture;
    if (picture.depth() == CV_32F) return bytes_of(picture, srgb_photometry());
    cv::Mat bytes;
    picture.convertTo(bytes, CV_8U, 1 / 257.0);
    return bytes;
}

cv::Mat picture_of(Frame const& f)
{
    bool const is_deep = f.format == PixelFormat::rgb16 || f.format == PixelFormat::rgb_linear;
    return is_deep ? f.planes[0] : rgb_of(f);
}

cv::Mat rgb_of(Frame const& f)
{
    cv::Mat rgb;
    switch (f.format) {
    case PixelFormat::rgb8:
        return f.planes[0];
    case PixelFormat::bgr8:
        cv::cvtColor(f.planes[0], rgb, cv::COLOR_BGR2RGB);
        return rgb;
    case PixelFormat::gray8:
        cv::cvtColor(f.planes[0], rgb, cv::COLOR_GRAY2RGB);
        return rgb;
    case PixelFormat::nv12:
        cv::cvtColorTwoPlane(f.planes[0], f.planes[1], rgb, cv::COLOR_YUV2RGB_NV12);
        return rgb;
    case PixelFormat::yuyv:
        cv::cvtColor(f.planes[0], rgb, cv::COLOR_YUV2RGB_YUYV);
        return rgb;
    case PixelFormat::mjpeg:
        cv::cvtColor(decoded(f, cv::IMREAD_COLOR), rgb, cv::COLOR_BGR2RGB);
        return rgb;
    case PixelFormat::rgb16:
    case PixelFormat::rgb_linear:
        return eight_bits_of(f.planes[0]);
    }
    throw std::logic_error("a pixel format without a way to RGB");
}

cv::Mat gray_of(Frame const& f)
{
    cv::Mat gray;
    switch (f.format) {
    case PixelFormat::rgb8:
        cv::cvtColor(f.planes[0], gray, cv::COLOR_RGB2GRAY);
        return gray;
    case PixelFormat::bgr8:
        cv::cvtColor(f.planes[0], gray, cv::COLOR_BGR2GRAY);
        return gray;
    case PixelFormat::gray8:
    case PixelFormat::nv12:
        return f.planes[0];
    case PixelFormat::yuyv:
        cv::cvtColor(f.planes[0], gray, cv::COLOR_YUV2GRAY_YUYV);
        return gray;
    case PixelFormat::mjpeg:
        return decoded(f, cv::IMREAD_GRAYSCALE);
    case PixelFormat::rgb16:
    case PixelFormat::rgb_linear:
        cv::cvtColor(eight_bits_of(f.planes[0]), gray, cv::COLOR_RGB2GRAY);
        return gray;
    }
    throw std::logic_error("a pixel format without luma");
}

} // namespace ar
