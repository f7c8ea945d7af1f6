#include "viewer/app/replayed_picture.h"

#include "viewer/displays/compose.h"
#include "viewer/engine/picture_margin.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

glm::ivec2 size_of(gi::Picture const& p) { return {p.width, p.height}; }

/// Which eye's pixel is where: 0 left, 1 right, 2 none.
struct EyePixel {
    int eye = 0;
    glm::ivec2 at{0};
};

EyePixel eye_pixel(StereoMode mode, glm::ivec2 eye, glm::ivec2 p)
{
    switch (mode) {
    case StereoMode::side_by_side:
        return {std::min(p.x / eye.x, 2), {p.x % eye.x, p.y}};
    case StereoMode::top_bottom:
        return {std::min(p.y / eye.y, 2), {p.x, p.y % eye.y}};
    case StereoMode::rows:
        return {p.y & 1, p};
    case StereoMode::columns:
        return {p.x & 1, p};
    case StereoMode::checkerboard:
        return {(p.x + p.y) & 1, p};
    default:
        return {0, p};
    }
}

} // namespace

gi::Picture resized(gi::Picture const& picture, glm::ivec2 size)
{
    if (size_of(picture) == size) return picture;
    gi::Picture out{size.x, size.y, {}, picture.metadata};
    for (gi::Layer const& from : picture.layers) {
        gi::Layer& to = out.add(from.name, from.channels);
        int const type = CV_32FC(from.channels);
        cv::Mat const in(picture.height, picture.width, type, const_cast<float*>(from.data.data()));
        cv::Mat fitting(size.y, size.x, type, to.data.data());
        cv::resize(in, fitting, fitting.size(), 0, 0, from.name == "color" ? cv::INTER_LINEAR : cv::INTER_NEAREST);
    }
    return out;
}

bool flickers_to_second(double time_s)
{
    constexpr double kFlicker_Hz = 2;
    return std::fmod(time_s * kFlicker_Hz, 1.0) < 0.5;
}

std::vector<unsigned char> shown_bytes(ViewPicture const& view, glm::ivec2 size, Settings const& settings,
                                       double time_s)
{
    auto const bytes_of = [&](gi::Picture const& picture) {
        gi::Picture const fitting = resized(without_margin(picture, view.margin_px), size);
        return gi::tone_map_bytes(*fitting.find("color"), tone_settings(settings));
    };
    std::vector<unsigned char> bytes = bytes_of(view.picture);
    if (!view.compared || settings.compare.empty() || settings.view == "picture") return bytes;
    std::vector<unsigned char> const other = bytes_of(*view.compared);
    if (settings.view == "flicker") return flickers_to_second(time_s) ? other : bytes;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        double const x = double(i / 3 % std::size_t(size.x)) + 0.5;
        if (settings.view == "difference")
            bytes[i] = static_cast<unsigned char>(std::abs(int(bytes[i]) - int(other[i])));
        else if (x >= settings.split * size.x)
            bytes[i] = other[i];
    }
    return bytes;
}

gi::Picture composed(Arrangement const& a, gi::Picture const& left, gi::Picture const& right)
{
    if (a.mode == StereoMode::off) return left;
    glm::ivec2 const eye = eye_size(a.mode, a.size_px);
    gi::Picture out{a.size_px.x, a.size_px.y, {}, left.metadata};
    for (gi::Layer const& of_left : left.layers) {
        gi::Layer const* const of_right = right.find(of_left.name);
        if (of_right == nullptr || of_right->channels != of_left.channels) continue;
        auto const channels = std::size_t(of_left.channels);
        std::vector<float>& to = out.add(of_left.name, of_left.channels).data;
        for (int y = 0; y < a.size_px.y; ++y)
            for (int x = 0; x < a.size_px.x; ++x) {
                EyePixel const from = eye_pixel(a.mode, eye, {x, y});
                if (from.eye > 1) continue;
                std::vector<float> const& data = from.eye == 0 ? of_left.data : of_right->data;
                std::copy_n(data.begin() + std::ptrdiff_t(channels * std::size_t(from.at.y * eye.x + from.at.x)),
                            channels, to.begin() + std::ptrdiff_t(channels * std::size_t(y * a.size_px.x + x)));
            }
    }
    return out;
}

std::vector<unsigned char> on_canvas(std::vector<unsigned char> bytes, glm::ivec2 from, glm::ivec2 to)
{
    if (from == to) return bytes;
    std::vector<unsigned char> out(3 * std::size_t(to.x) * std::size_t(to.y));
    glm::ivec2 const size = fitted(double(from.x) / from.y, to), corner = (to - size) / 2;
    cv::Mat const in(from.y, from.x, CV_8UC3, bytes.data());
    cv::Mat canvas(to.y, to.x, CV_8UC3, out.data());
    cv::Mat fitting;
    cv::resize(in, fitting, {size.x, size.y}, 0, 0, cv::INTER_LINEAR);
    fitting.copyTo(canvas(cv::Rect(corner.x, corner.y, size.x, size.y)));
    return out;
}

gi::Picture on_canvas(gi::Picture picture, glm::ivec2 to)
{
    if (size_of(picture) == to) return picture;
    glm::ivec2 const size = fitted(double(picture.width) / picture.height, to), corner = (to - size) / 2;
    gi::Picture const fitting = resized(picture, size);
    gi::Picture out{to.x, to.y, {}, picture.metadata};
    for (gi::Layer const& from : fitting.layers) {
        gi::Layer& layer = out.add(from.name, from.channels);
        int const type = CV_32FC(from.channels);
        cv::Mat canvas(to.y, to.x, type, layer.data.data());
        cv::Mat(size.y, size.x, type, const_cast<float*>(from.data.data()))
            .copyTo(canvas(cv::Rect(corner.x, corner.y, size.x, size.y)));
    }
    return out;
}

} // namespace viewer
