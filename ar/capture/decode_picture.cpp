#include "ar/capture/decode_picture.h"

#include "ar/capture/whole_picture.h"
#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

DecodedPicture refused(std::string problem) { return {.problem = std::move(problem)}; }

DecodedPicture decoded_exr(std::span<std::uint8_t const> bytes, bool is_matte)
{
    gi::Picture picture;
    try {
        picture = gi::decode_picture(bytes, "it");
    } catch (gi::InputError const& e) {
        return refused(e.problem() + " (" + e.why() + ")");
    }
    gi::Layer const* color = picture.find("color");
    if (!color && is_matte) color = picture.find("A");
    if (!color) {
        std::string names;
        for (gi::Layer const& layer : picture.layers) names += (names.empty() ? "" : ", ") + layer.name;
        return refused(
            fmt::format("the EXR has no channels R, G and B, or Y, without a layer (its layers: {})", names));
    }
    DecodedPicture out{.format = PixelFormat::rgb_linear, .notes = picture.notes};
    out.pixels.create(picture.height, picture.width, CV_32FC3);
    auto const n = std::size_t(color->channels);
    for (std::size_t i = 0; i < picture.pixels(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            out.pixels.ptr<float>()[3 * i + c] = color->data[n * i + (n == 1 ? 0 : c)];
    return out;
}

} // namespace

DecodedPicture decoded_picture(std::span<std::uint8_t const> bytes, bool is_matte)
{
    if (is_exr(bytes)) return decoded_exr(bytes, is_matte);
    if (std::string missing = what_is_missing(bytes); !missing.empty()) return refused(std::move(missing));
    if (!is_picture(bytes)) return refused("it is no picture that is known here");
    DecodedPicture out;
    try {
        cv::Mat const all(1, int(bytes.size()), CV_8UC1, const_cast<std::uint8_t*>(bytes.data()));
        out.pixels = cv::imdecode(all, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH);
    } catch (cv::Exception const& e) {
        return refused("it cannot be decoded: " + e.err);
    }
    cv::Mat& pixels = out.pixels;
    if (pixels.empty()) return refused("it cannot be decoded");
    bool const is_grey = pixels.channels() == 1;
    if (pixels.depth() == CV_8U) {
        out.format = is_grey ? PixelFormat::gray8 : PixelFormat::bgr8;
        return out;
    }
    if (pixels.depth() != CV_16U && pixels.depth() != CV_32F)
        return refused("its pixels are neither of 8 or 16 bits nor float");
    out.format = pixels.depth() == CV_16U ? PixelFormat::rgb16 : PixelFormat::rgb_linear;
    cv::Mat rgb;
    cv::cvtColor(pixels, rgb, is_grey ? cv::COLOR_GRAY2RGB : cv::COLOR_BGR2RGB);
    pixels = rgb;
    return out;
}

} // namespace ar
