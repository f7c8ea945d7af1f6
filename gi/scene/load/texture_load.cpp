#include "gi/core/claimed_size.h"
#include "gi/core/error.h"
#include "gi/core/huge_pages.h"
#include "gi/scene/load/load.h"

#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace gi {
namespace {

constexpr std::size_t kMostTexels = std::size_t(1) << 28;      ///< of one texture: 16384 x 16384
constexpr std::size_t kMostTexelsOfAll = std::size_t(1) << 32; ///< of a pool: 16 GiB

} // namespace

std::int32_t add_texture(TexturePool& pool, unsigned char const* bytes, std::size_t size, bool srgb,
                         std::string const& name)
{
    auto const bad = [&](std::string const& why) {
        return InputError("cannot read the texture '" + name + "'", why, "save it as PNG or JPEG");
    };
    if (size == 0 || size > (std::size_t(1) << 31)) throw bad("it is empty or larger than 2 GiB");
    if (claimed_pixels({bytes, size}) > kMostTexels) throw bad("it is larger than 16384 x 16384");
    if (size >= 4 && std::memcmp(bytes, "\x76\x2f\x31\x01", 4) == 0)
        throw bad("it is OpenEXR: textures have 8 or 16 bits per channel");
    cv::Mat image;
    try {
        cv::Mat const raw(1, int(size), CV_8U, const_cast<unsigned char*>(bytes));
        image = cv::imdecode(raw, cv::IMREAD_UNCHANGED | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (cv::Exception const& e) {
        throw bad(e.what());
    }
    if (image.empty()) throw bad("its format is not supported, or it is damaged");
    if (image.depth() == CV_16U) image.convertTo(image, CV_8U, 1.0 / 257);
    if (image.depth() != CV_8U) throw bad("it has neither 8 nor 16 bits per channel");
    int const conversion = image.channels() == 1   ? cv::COLOR_GRAY2RGBA
                           : image.channels() == 3 ? cv::COLOR_BGR2RGBA
                           : image.channels() == 4 ? cv::COLOR_BGRA2RGBA
                                                   : -1;
    if (conversion < 0) throw bad("it has neither 1, 3 nor 4 channels");
    if (image.total() > kMostTexels || pool.texels.size() + image.total() > kMostTexelsOfAll)
        throw bad("it is larger than 16384 x 16384, or all textures together than 2^32 texels");
    cv::cvtColor(image, image, conversion);

    Texture t;
    t.first = pool.texels.size();
    t.width = std::uint32_t(image.cols);
    t.height = std::uint32_t(image.rows);
    t.srgb = srgb;
    resize_on_huge_pages(pool.texels, pool.texels.size() + std::size_t(t.width) * t.height);
    for (int y = 0; y < image.rows; ++y)
        std::memcpy(pool.texels.data() + t.first + std::size_t(y) * t.width, image.ptr(y),
                    sizeof(Rgba8) * std::size_t(t.width));
    pool.textures.push_back(t);
    return std::int32_t(pool.textures.size()) - 1;
}

} // namespace gi
