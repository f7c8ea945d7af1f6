#include "gi/image_io/picture_file.h"

#include "gi/core/claimed_size.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/srgb.h"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace gi {
namespace {

constexpr std::size_t kMostPixels = std::size_t(1) << 29, kMostBytes = std::size_t(1) << 31;
constexpr std::size_t kMostPixelsPerByte = 8 * 1032; ///< a one-bit PNG at the highest ratio of deflate

bool starts_with(std::span<unsigned char const> bytes, std::string_view magic)
{
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

/// True for the formats passed to OpenCV, which would try its many other decoders on unknown bytes.
bool is_known(std::span<unsigned char const> bytes)
{
    using namespace std::string_view_literals;
    for (std::string_view const magic : {"\x89PNG\r\n\x1a\n"sv, "\xff\xd8\xff"sv, "II*\0"sv, "MM\0*"sv, "BM"sv})
        if (starts_with(bytes, magic)) return true;
    return starts_with(bytes, "RIFF") && bytes.size() > 12 && starts_with(bytes.subspan(8), "WEBP");
}

/// Only the layer "color": R, G, B of others may be no colours (normals, data).
void convert_to_rec709(Picture& picture)
{
    if (!picture.primaries) return;
    Primaries const& p = *picture.primaries;
    auto const text = [](glm::dvec2 xy) { return fmt::format("({:.4g}, {:.4g})", xy.x, xy.y); };
    std::string note = fmt::format("its primaries are {}, {}, {} and white {}: ", text(p.red), text(p.green),
                                   text(p.blue), text(p.white));
    Layer* const color = picture.find("color");
    if (color != nullptr && color->channels >= 3) {
        glm::dmat3 const m = *to_rec709(p);
        auto const n = std::size_t(color->channels);
        for (std::size_t i = 0; i < picture.pixels(); ++i) {
            float* const c = &color->data[i * n];
            dvec3 const converted = m * dvec3(c[0], c[1], c[2]);
            for (int k = 0; k < 3; ++k) c[k] = float(converted[k]);
        }
        picture.primaries.reset();
        note += "its colours are converted to Rec. 709";
        if (picture.layers.size() > 1) note += ", its other layers are as they were";
    } else {
        note += "its layers are as they were";
    }
    picture.notes.push_back(note);
}

} // namespace

Picture decode_stored(std::span<unsigned char const> bytes, std::string const& name)
{
    if (starts_with(bytes, "\x76\x2f\x31\x01")) {
        Picture picture = decode_exr(bytes, name);
        convert_to_rec709(picture);
        return picture;
    }
    if (starts_with(bytes, "#?")) return decode_hdr(bytes, name);
    auto const bad = [&](std::string const& why) {
        return InputError("cannot read '" + name + "' as a picture", why,
                          "give OpenEXR, Radiance HDR, PNG, JPEG, TIFF, BMP or WebP");
    };
    if (bytes.empty()) throw bad("it is empty");
    if (!is_known(bytes)) throw bad("its first bytes match no supported format");
    if (bytes.size() >= kMostBytes) throw bad("it is larger than 2 GiB");
    std::size_t const claimed = claimed_pixels(bytes);
    if (claimed > kMostPixels || claimed / kMostPixelsPerByte > bytes.size())
        throw bad("its header states " + std::to_string(claimed) + " pixels");
    cv::Mat image;
    try {
        cv::Mat const raw(1, int(bytes.size()), CV_8U, const_cast<unsigned char*>(bytes.data()));
        image = cv::imdecode(raw, cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH);
    } catch (cv::Exception const& e) {
        throw bad(e.what());
    }
    if (image.empty()) throw bad("it is damaged");
    if (image.total() > kMostPixels) throw bad("it has more than 2^29 pixels");

    bool const encoded = image.depth() == CV_8U || image.depth() == CV_16U;
    double const scale = image.depth() == CV_8U ? 1.0 / 255 : image.depth() == CV_16U ? 1.0 / 65535 : 1.0;
    cv::Mat linear;
    image.convertTo(linear, CV_32FC3, scale);
    cv::cvtColor(linear, linear, cv::COLOR_BGR2RGB);
    Picture picture;
    picture.width = linear.cols;
    picture.height = linear.rows;
    Layer& layer = picture.add("color", 3);
    for (int y = 0; y < linear.rows; ++y)
        std::memcpy(layer.data.data() + std::size_t(y) * std::size_t(linear.cols) * 3, linear.ptr<float>(y),
                    std::size_t(linear.cols) * 3 * sizeof(float));
    picture.ends_at_one = encoded;
    return picture;
}

Picture decode_picture(std::span<unsigned char const> bytes, std::string const& name)
{
    Picture picture = decode_stored(bytes, name);
    if (picture.ends_at_one)
        for (float& v : picture.layers[0].data) v = decode_srgb(v);
    return picture;
}

Picture read_picture(std::filesystem::path const& file) { return decode_picture(read_bytes(file), file.string()); }

} // namespace gi
