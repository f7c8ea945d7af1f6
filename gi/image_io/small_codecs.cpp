#include "gi/image_io/small_codecs.h"

#include <algorithm>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

// A copy of our own: libdraco exports another one.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#include <stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace gi {
namespace {

using Bytes = std::span<unsigned char const>;

/// The orientation of an Exif block (its TIFF part), 1 to 8; 1 if it has none.
int orientation_of_exif(Bytes tiff)
{
    if (tiff.size() < 14) return 1;
    bool const is_little = tiff[0] == 'I';
    auto const number = [&](std::size_t at, std::size_t count) {
        unsigned value = 0;
        for (std::size_t k = 0; k < count; ++k) value = value << 8 | tiff[at + (is_little ? count - 1 - k : k)];
        return std::size_t(value);
    };
    std::size_t const directory = number(4, 4);
    if (directory > tiff.size() - 2) return 1;
    std::size_t const entries = number(directory, 2);
    for (std::size_t k = 0, at = directory + 2; k < entries && at + 12 <= tiff.size(); ++k, at += 12)
        if (number(at, 2) == 0x0112) {
            std::size_t const orientation = number(at + 8, 2);
            return orientation >= 1 && orientation <= 8 ? int(orientation) : 1;
        }
    return 1;
}

/// The orientation in which a JPEG wants to be shown (Exif 2.3, tag 274).
int orientation_of_jpeg(Bytes bytes)
{
    static constexpr unsigned char kExif[]{'E', 'x', 'i', 'f', 0, 0};
    if (bytes.size() < 4 || bytes[0] != 0xff || bytes[1] != 0xd8) return 1;
    for (std::size_t at = 2; at + 4 <= bytes.size() && bytes[at] == 0xff && bytes[at + 1] != 0xda;) {
        std::size_t const length = std::size_t(bytes[at + 2]) << 8 | bytes[at + 3];
        Bytes const rest = bytes.subspan(at + 4);
        if (length < 2 || length - 2 > rest.size()) return 1;
        Bytes const segment = rest.first(length - 2);
        if (bytes[at + 1] == 0xe1 && segment.size() > sizeof kExif &&
            std::equal(std::begin(kExif), std::end(kExif), segment.begin()))
            return orientation_of_exif(segment.subspan(sizeof kExif));
        at += 2 + length;
    }
    return 1;
}

/// Turns a picture upright.
void apply_orientation(cv::Mat& image, int orientation)
{
    if (orientation >= 5) cv::transpose(image, image);
    bool const is_mirrored = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    bool const is_upside_down = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    if (is_mirrored && is_upside_down)
        cv::flip(image, image, -1);
    else if (is_mirrored || is_upside_down)
        cv::flip(image, image, is_mirrored ? 1 : 0);
}

} // namespace

cv::Mat decode_small(Bytes bytes, int flags)
{
    int width = 0, height = 0, channels = 0;
    int const size = int(bytes.size());
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) return {};
    bool const unchanged = flags == cv::IMREAD_UNCHANGED;
    bool const is_wide =
        (unchanged || (flags & cv::IMREAD_ANYDEPTH) != 0) && stbi_is_16_bit_from_memory(bytes.data(), size) != 0;
    bool const keeps_grey = unchanged || (flags & cv::IMREAD_ANYCOLOR) != 0;
    int const wanted = unchanged && channels != 1 ? (channels == 3 ? 3 : 4) : keeps_grey && channels <= 2 ? 1 : 3;
    std::unique_ptr<void, void (*)(void*)> const pixels(
        is_wide
            ? static_cast<void*>(stbi_load_16_from_memory(bytes.data(), size, &width, &height, &channels, wanted))
            : static_cast<void*>(stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, wanted)),
        stbi_image_free);
    if (!pixels) return {};
    cv::Mat image = cv::Mat(height, width, CV_MAKETYPE(is_wide ? CV_16U : CV_8U, wanted), pixels.get()).clone();
    if (wanted >= 3) cv::cvtColor(image, image, wanted == 3 ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGRA);
    if (!unchanged && (flags & (cv::IMREAD_COLOR | cv::IMREAD_ANYCOLOR)) == 0 && wanted == 3)
        cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
    if (!unchanged && (flags & cv::IMREAD_IGNORE_ORIENTATION) == 0)
        apply_orientation(image, orientation_of_jpeg(bytes));
    return image;
}

std::vector<unsigned char> encode_small(std::string const& extension, cv::Mat const& bgr, int jpeg_quality)
{
    if (bgr.depth() != CV_8U || bgr.empty()) return {};
    cv::Mat image = bgr;
    if (bgr.channels() == 3) cv::cvtColor(bgr, image, cv::COLOR_BGR2RGB);
    if (bgr.channels() == 4) cv::cvtColor(bgr, image, cv::COLOR_BGRA2RGBA);
    if (!image.isContinuous()) image = image.clone();
    std::vector<unsigned char> out;
    auto const add = [](void* to, void* data, int size) {
        auto const* const first = static_cast<unsigned char const*>(data);
        static_cast<std::vector<unsigned char>*>(to)->insert(static_cast<std::vector<unsigned char>*>(to)->end(),
                                                             first, first + size);
    };
    int done = 0;
    if (extension == ".png")
        done = stbi_write_png_to_func(add, &out, image.cols, image.rows, image.channels(), image.data,
                                      int(image.step));
    else if (extension == ".jpg" || extension == ".jpeg")
        done =
            stbi_write_jpg_to_func(add, &out, image.cols, image.rows, image.channels(), image.data, jpeg_quality);
    else if (extension == ".bmp")
        done = stbi_write_bmp_to_func(add, &out, image.cols, image.rows, image.channels(), image.data);
    return done != 0 ? out : std::vector<unsigned char>();
}

} // namespace gi
