#include "gi/base/error.h"
#include "gi/scene/load.h"

#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace gi {
namespace {

constexpr std::size_t kMostTexels = std::size_t(1) << 28;      ///< of one texture: 16384 x 16384
constexpr std::size_t kMostTexelsOfAll = std::size_t(1) << 32; ///< of a pool: 16 GiB

std::size_t big_endian(unsigned char const* p, int bytes)
{
    std::size_t v = 0;
    for (int i = 0; i < bytes; ++i) v = v << 8 | p[i];
    return v;
}

/// width * height as the header of a PNG or JPEG says, before a decoder makes room for that; 0 = not known.
std::size_t claimed_texels(unsigned char const* bytes, std::size_t size)
{
    if (size >= 24 && std::memcmp(bytes, "\x89PNG", 4) == 0)
        return big_endian(bytes + 16, 4) * big_endian(bytes + 20, 4);
    if (size < 4 || bytes[0] != 0xff || bytes[1] != 0xd8) return 0;
    for (std::size_t at = 2; at + 9 <= size && bytes[at] == 0xff;) { // the segments of a JPEG
        unsigned const marker = bytes[at + 1];
        bool const start_of_frame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (start_of_frame) return big_endian(bytes + at + 5, 2) * big_endian(bytes + at + 7, 2);
        at += marker == 0xff ? 1 : 2 + big_endian(bytes + at + 2, 2);
    }
    return 0;
}

} // namespace

std::int32_t add_texture(TexturePool& pool, unsigned char const* bytes, std::size_t size, bool srgb,
                         std::string const& name)
{
    auto const bad = [&](std::string const& why) {
        return InputError("cannot read the texture '" + name + "'", why, "save it as PNG or JPEG");
    };
    if (size == 0 || size > (std::size_t(1) << 31)) throw bad("it is empty or larger than 2 GiB");
    if (claimed_texels(bytes, size) > kMostTexels) throw bad("it is larger than 16384 x 16384");
    cv::Mat image;
    try {
        cv::Mat const raw(1, int(size), CV_8U, const_cast<unsigned char*>(bytes));
        image = cv::imdecode(raw, cv::IMREAD_UNCHANGED | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (cv::Exception const& e) {
        throw bad(e.what());
    }
    if (image.empty()) throw bad("no decoder knows it, or it is damaged");
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
    pool.texels.resize(pool.texels.size() + std::size_t(t.width) * t.height);
    for (int y = 0; y < image.rows; ++y)
        std::memcpy(pool.texels.data() + t.first + std::size_t(y) * t.width, image.ptr(y),
                    sizeof(Rgba8) * std::size_t(t.width));
    pool.textures.push_back(t);
    return std::int32_t(pool.textures.size()) - 1;
}

} // namespace gi
