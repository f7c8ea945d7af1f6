#include "gi/base/picture_file.h"

#include "gi/base/error.h"
#include "gi/base/file.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace gi {
namespace {

bool starts_with(std::span<unsigned char const> bytes, std::string_view magic)
{
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

float decode_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

} // namespace

Picture decode_picture(std::span<unsigned char const> bytes, std::string const& name)
{
    if (starts_with(bytes, "\x76\x2f\x31\x01")) return decode_exr(bytes, name);
    if (starts_with(bytes, "#?")) return decode_hdr(bytes, name);
    auto const bad = [&](std::string const& why) {
        return InputError("cannot read '" + name + "' as a picture", why,
                          "give OpenEXR, Radiance HDR, PNG, JPEG or TIFF");
    };
    if (bytes.empty()) throw bad("it is empty");
    cv::Mat image;
    try {
        cv::Mat const raw(1, int(bytes.size()), CV_8U, const_cast<unsigned char*>(bytes.data()));
        image = cv::imdecode(raw, cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH);
    } catch (cv::Exception const& e) {
        throw bad(e.what());
    }
    if (image.empty()) throw bad("no decoder knows it, or it is damaged");

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
    if (encoded)
        for (float& v : layer.data) v = decode_srgb(v);
    return picture;
}

Picture read_picture(std::filesystem::path const& file) { return decode_picture(read_bytes(file), file.string()); }

void write_png(std::filesystem::path const& file, int width, int height, std::span<unsigned char const> rgb8)
{
    cv::Mat const rgb(height, width, CV_8UC3, const_cast<unsigned char*>(rgb8.data()));
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    std::vector<unsigned char> bytes;
    cv::imencode(".png", bgr, bytes);
    write_by_rename(file, [&](std::filesystem::path const& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.exceptions(std::ios::failbit | std::ios::badbit);
        out.write(reinterpret_cast<char const*>(bytes.data()), std::streamsize(bytes.size()));
        out.flush();
    });
}

} // namespace gi
