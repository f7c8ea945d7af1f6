#include "ar/capture/camera_pixels.h"

#include "ar/capture/whole_picture.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr auto kPixels = std::to_array<CameraPixels>({
    {fourcc("NV12"), PixelFormat::nv12, false},
    {fourcc("BG24"), PixelFormat::rgb8, false}, // BGR888: R, G, B in memory
    {fourcc("RG24"), PixelFormat::bgr8, false}, // RGB888
    {fourcc("YUYV"), PixelFormat::yuyv, false},
    {fourcc("MJPG"), PixelFormat::mjpeg, false},
    {fourcc("NV21"), PixelFormat::nv12, true},
    {fourcc("YU12"), PixelFormat::nv12, true}, // YUV420
    {fourcc("YV12"), PixelFormat::nv12, true}, // YVU420
    {fourcc("UYVY"), PixelFormat::yuyv, true},
    {fourcc("YVYU"), PixelFormat::yuyv, true},
    {fourcc("VYUY"), PixelFormat::yuyv, true},
    {fourcc("XR24"), PixelFormat::bgr8, true}, // XRGB8888: B, G, R, X in memory
    {fourcc("AR24"), PixelFormat::bgr8, true},
    {fourcc("XB24"), PixelFormat::rgb8, true}, // XBGR8888: R, G, B, X
    {fourcc("AB24"), PixelFormat::rgb8, true},
    {fourcc("RX24"), PixelFormat::bgr8, true}, // RGBX8888: X, B, G, R
    {fourcc("RA24"), PixelFormat::bgr8, true},
    {fourcc("BX24"), PixelFormat::rgb8, true}, // BGRX8888: X, R, G, B
    {fourcc("BA24"), PixelFormat::rgb8, true},
    {fourcc("R8  "), PixelFormat::gray8, false},
});

bool is_one_of(std::uint32_t code, std::initializer_list<std::uint32_t> codes)
{
    return std::find(codes.begin(), codes.end(), code) != codes.end();
}

bool has_three_planes(std::uint32_t code) { return is_one_of(code, {fourcc("YU12"), fourcc("YV12")}); }

bool is_alpha_first(std::uint32_t code)
{
    return is_one_of(code, {fourcc("RX24"), fourcc("RA24"), fourcc("BX24"), fourcc("BA24")});
}

int bytes_per_pixel(std::uint32_t code)
{
    if (is_one_of(code, {fourcc("BG24"), fourcc("RG24")})) return 3;
    if (is_one_of(code, {fourcc("YUYV"), fourcc("UYVY"), fourcc("YVYU"), fourcc("VYUY")})) return 2;
    PixelFormat const format = camera_pixels_of(code)->format;
    return format == PixelFormat::rgb8 || format == PixelFormat::bgr8 ? 4 : 1;
}

cv::Mat plane_at(std::span<std::uint8_t const> memory, int rows, int cols, int type, std::size_t stride)
{
    return {rows, cols, type, const_cast<std::uint8_t*>(memory.data()), stride}; // frames are read only
}

/// Splits one or several memory spans into planes; empty if one is too short.
std::vector<std::span<std::uint8_t const>> cut(std::span<std::span<std::uint8_t const> const> memory,
                                               std::vector<std::size_t> const& bytes)
{
    std::vector<std::span<std::uint8_t const>> planes;
    if (memory.size() == 1) {
        std::size_t at = 0;
        for (std::size_t const n : bytes) {
            if (memory[0].size() - at < n) return {};
            planes.push_back(memory[0].subspan(at, n));
            at += n;
        }
        return planes;
    }
    if (memory.size() < bytes.size()) return {};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (memory[i].size() < bytes[i]) return {};
        planes.push_back(memory[i].first(bytes[i]));
    }
    return planes;
}

/// Minimum bytes of each plane: the last row needs no padding.
std::vector<std::size_t> least_bytes(std::uint32_t code, glm::ivec2 size, std::size_t stride, bool in_one_piece)
{
    std::vector<std::size_t> bytes = plane_bytes(code, size, stride, 0);
    std::size_t const row = std::size_t(size.x) * std::size_t(bytes_per_pixel(code));
    auto const short_of = [&](std::size_t plane) {
        std::size_t const chroma = has_three_planes(code) && plane > 0 ? 2 : 1;
        return (stride - row) / chroma;
    };
    for (std::size_t i = 0; i < bytes.size(); ++i)
        if (!in_one_piece || i + 1 == bytes.size()) bytes[i] -= std::min(bytes[i], short_of(i));
    return bytes;
}

void set_chroma_420(Frame& f, std::uint32_t code, std::span<std::span<std::uint8_t const> const> planes,
                    std::size_t stride)
{
    int const rows = f.size_px.y / 2, cols = f.size_px.x / 2;
    f.planes[0] = plane_at(planes[0], f.size_px.y, f.size_px.x, CV_8UC1, stride);
    if (has_three_planes(code)) {
        cv::Mat const first = plane_at(planes[1], rows, cols, CV_8UC1, stride / 2);
        cv::Mat const second = plane_at(planes[2], rows, cols, CV_8UC1, stride / 2);
        bool const is_u_first = code == fourcc("YU12");
        cv::merge(std::array{is_u_first ? first : second, is_u_first ? second : first}, f.planes[1]);
        return;
    }
    f.planes[1] = plane_at(planes[1], rows, cols, CV_8UC2, stride);
    if (code == fourcc("NV21")) {
        cv::Mat swapped(rows, cols, CV_8UC2);
        cv::mixChannels(f.planes[1], swapped, {0, 1, 1, 0});
        f.planes[1] = swapped;
    }
}

/// Two pixels are one of four channels.
cv::Mat reordered_422(cv::Mat const& pairs, std::uint32_t code)
{
    cv::Mat out(pairs.size(), CV_8UC4);
    if (code == fourcc("UYVY")) cv::mixChannels(pairs, out, {1, 0, 0, 1, 3, 2, 2, 3});
    if (code == fourcc("VYUY")) cv::mixChannels(pairs, out, {1, 0, 2, 1, 3, 2, 0, 3});
    if (code == fourcc("YVYU")) cv::mixChannels(pairs, out, {0, 0, 3, 1, 2, 2, 1, 3});
    return out.reshape(2);
}

} // namespace

std::string name_of_fourcc(std::uint32_t code)
{
    std::string name;
    for (int i = 0; i < 4; ++i) {
        char const c = char(code >> (8 * i) & 0xff);
        name += c >= ' ' && c <= '~' ? c : '?';
    }
    return name;
}

std::span<CameraPixels const> camera_pixels() { return kPixels; }

std::optional<CameraPixels> camera_pixels_of(std::uint32_t code)
{
    auto const found =
        std::find_if(kPixels.begin(), kPixels.end(), [&](CameraPixels const& p) { return p.fourcc == code; });
    return found == kPixels.end() ? std::nullopt : std::optional(*found);
}

std::vector<std::size_t> plane_bytes(std::uint32_t code, glm::ivec2 size, std::size_t stride,
                                     std::size_t frame_bytes)
{
    auto const rows = std::size_t(size.y);
    auto const pixels = camera_pixels_of(code);
    if (pixels && pixels->format == PixelFormat::nv12) {
        if (has_three_planes(code)) return {stride * rows, stride / 2 * (rows / 2), stride / 2 * (rows / 2)};
        return {stride * rows, stride * (rows / 2)};
    }
    if (pixels && pixels->format == PixelFormat::mjpeg) return {frame_bytes};
    return {std::max(stride * rows, frame_bytes)};
}

std::string set_planes(Frame& f, std::uint32_t code, glm::ivec2 size, std::size_t stride,
                       std::span<std::span<std::uint8_t const> const> memory)
{
    auto const pixels = camera_pixels_of(code);
    if (!pixels) return "its pixel format " + name_of_fourcc(code) + " is not known here";
    f.format = pixels->format;
    f.size_px = size;
    f.planes = {};
    if (memory.empty()) return "it has no memory";
    if (pixels->format == PixelFormat::mjpeg) {
        if (!is_jpeg(memory[0])) return "it is no JPEG";
        if (std::string missing = what_is_missing(memory[0]); !missing.empty()) return missing;
        f.planes[0] = plane_at(memory[0], 1, int(memory[0].size()), CV_8UC1, memory[0].size());
        return {};
    }
    std::size_t const row = std::size_t(size.x) * std::size_t(bytes_per_pixel(code));
    bool const has_pairs = pixels->format == PixelFormat::nv12 || pixels->format == PixelFormat::yuyv;
    if (stride < row) return fmt::format("its rows have {} bytes, {} pixels need {}", stride, size.x, row);
    if (has_pairs && (size.x % 2 != 0 || (pixels->format == PixelFormat::nv12 && size.y % 2 != 0)))
        return fmt::format("{} x {} pixels are no whole number of colours in {}", size.x, size.y,
                           name_of_fourcc(code));
    auto const needed = least_bytes(code, size, stride, memory.size() == 1);
    auto const planes = cut(memory, needed);
    if (planes.empty()) {
        std::size_t has = 0, needs = 0;
        for (auto const& m : memory) has += m.size();
        for (std::size_t const n : needed) needs += n;
        return fmt::format("truncated: {} bytes of {}", has, needs);
    }
    switch (pixels->format) {
    case PixelFormat::nv12:
        set_chroma_420(f, code, planes, stride);
        break;
    case PixelFormat::yuyv:
        if (pixels->is_copied)
            f.planes[0] = reordered_422(plane_at(planes[0], size.y, size.x / 2, CV_8UC4, stride), code);
        else
            f.planes[0] = plane_at(planes[0], size.y, size.x, CV_8UC2, stride);
        break;
    case PixelFormat::gray8:
        f.planes[0] = plane_at(planes[0], size.y, size.x, CV_8UC1, stride);
        break;
    default:
        if (bytes_per_pixel(code) == 3) {
            f.planes[0] = plane_at(planes[0], size.y, size.x, CV_8UC3, stride);
            break;
        }
        int const first = is_alpha_first(code) ? 1 : 0;
        f.planes[0].create(size.y, size.x, CV_8UC3);
        cv::mixChannels(plane_at(planes[0], size.y, size.x, CV_8UC4, stride), f.planes[0],
                        {first, 0, first + 1, 1, first + 2, 2});
    }
    return {};
}

} // namespace ar
