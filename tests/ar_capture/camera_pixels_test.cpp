#include "ar/capture/camera_pixels.h"
#include "tests/ar_capture/temporary_folder.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

using Memory = std::vector<std::span<std::uint8_t const>>;

constexpr glm::ivec2 kSize{8, 4};

/// One buffer with rows of `stride` bytes, of bytes that tell where they are.
struct Buffer {
    explicit Buffer(std::size_t bytes) : data(bytes)
    {
        for (std::size_t i = 0; i < bytes; ++i) data[i] = std::uint8_t(37 * i + i / 7);
    }
    std::vector<std::uint8_t> data;
};

TEST(CameraPixels, WhatIsInOrderIsNotCopied)
{
    for (char const* name : {"NV12", "BG24", "RG24", "YUYV", "R8  "}) {
        std::uint32_t const code = fourcc({name[0], name[1], name[2], name[3], 0});
        std::size_t const stride = 32;
        Buffer const b(stride * 6);
        Memory const memory{std::span(b.data)};
        Frame f;
        ASSERT_EQ(set_planes(f, code, kSize, stride, memory), "") << name;
        EXPECT_EQ(f.planes[0].data, b.data.data()) << name;
        EXPECT_EQ(f.planes[0].step[0], stride);
        EXPECT_FALSE(camera_pixels_of(code)->is_copied);
        if (f.format == PixelFormat::nv12) {
            EXPECT_EQ(f.planes[1].data, b.data.data() + 4 * stride);
        }
    }
}

TEST(CameraPixels, PlanesMayLieApart)
{
    Buffer const luma(8 * 4), chroma(8 * 2);
    Memory const memory{std::span(luma.data), std::span(chroma.data)};
    Frame f;
    ASSERT_EQ(set_planes(f, fourcc("NV12"), kSize, 8, memory), "");
    EXPECT_EQ(f.planes[0].data, luma.data.data());
    EXPECT_EQ(f.planes[1].data, chroma.data.data());
    EXPECT_EQ(gray_of(f).data, luma.data.data());
}

TEST(CameraPixels, OrderOfComponents)
{
    struct Case {
        char const* name;
        std::vector<std::uint8_t> bytes; // of one pixel: red 10, green 20, blue 30
    };
    for (Case const& c :
         {Case{"BG24", {10, 20, 30}}, Case{"RG24", {30, 20, 10}}, Case{"XR24", {30, 20, 10, 99}},
          Case{"AR24", {30, 20, 10, 99}}, Case{"XB24", {10, 20, 30, 99}}, Case{"AB24", {10, 20, 30, 99}},
          Case{"RX24", {99, 30, 20, 10}}, Case{"RA24", {99, 30, 20, 10}}, Case{"BX24", {99, 10, 20, 30}},
          Case{"BA24", {99, 10, 20, 30}}}) {
        std::vector<std::uint8_t> row;
        for (int i = 0; i < 4; ++i) row.insert(row.end(), c.bytes.begin(), c.bytes.end());
        Frame f;
        ASSERT_EQ(set_planes(f, fourcc({c.name[0], c.name[1], c.name[2], c.name[3], 0}), {4, 1}, row.size(),
                             Memory{std::span<std::uint8_t const>(row)}),
                  "");
        EXPECT_EQ(rgb_of(f).at<cv::Vec3b>(0, 3), cv::Vec3b(10, 20, 30)) << c.name;
    }
}

TEST(CameraPixels, AllOrdersOfYuvAreTheSamePicture)
{
    // Y 100, 110 (two pixels), U 90, V 170.
    auto const frame = [](char const* name, glm::ivec2 size, std::size_t stride,
                          std::vector<std::uint8_t> const& bytes) {
        Frame f;
        EXPECT_EQ(set_planes(f, fourcc({name[0], name[1], name[2], name[3], 0}), size, stride,
                             Memory{std::span<std::uint8_t const>(bytes)}),
                  "")
            << name;
        f.planes = {f.planes[0].clone(), f.planes[1].clone()};
        return f;
    };
    Frame const yuyv = frame("YUYV", {2, 1}, 4, {100, 90, 110, 170});
    EXPECT_TRUE(equal(frame("UYVY", {2, 1}, 4, {90, 100, 170, 110}).planes[0], yuyv.planes[0]));
    EXPECT_TRUE(equal(frame("YVYU", {2, 1}, 4, {100, 170, 110, 90}).planes[0], yuyv.planes[0]));
    EXPECT_TRUE(equal(frame("VYUY", {2, 1}, 4, {170, 100, 90, 110}).planes[0], yuyv.planes[0]));

    Frame const nv12 = frame("NV12", {2, 2}, 2, {100, 110, 120, 130, 90, 170});
    for (Frame const& f : {frame("NV21", {2, 2}, 2, {100, 110, 120, 130, 170, 90}),
                           frame("YU12", {2, 2}, 2, {100, 110, 120, 130, 90, 170}),
                           frame("YV12", {2, 2}, 2, {100, 110, 120, 130, 170, 90})}) {
        EXPECT_TRUE(equal(f.planes[0], nv12.planes[0]));
        EXPECT_TRUE(equal(f.planes[1], nv12.planes[1]));
        EXPECT_TRUE(equal(rgb_of(f), rgb_of(nv12)));
    }
}

TEST(CameraPixels, EveryTruncationIsRefused)
{
    for (CameraPixels const& p : camera_pixels()) {
        if (p.format == PixelFormat::mjpeg) continue;
        std::size_t const stride = 40;
        std::size_t all = 0;
        for (std::size_t const n : plane_bytes(p.fourcc, kSize, stride, 0)) all += n;
        Buffer const b(all);
        Frame f;
        EXPECT_EQ(set_planes(f, p.fourcc, kSize, stride, Memory{std::span(b.data)}), "")
            << name_of_fourcc(p.fourcc);
        std::size_t accepted = 0;
        for (std::size_t n = 0; n < all; ++n)
            accepted += set_planes(f, p.fourcc, kSize, stride, Memory{std::span(b.data).first(n)}).empty();
        EXPECT_LE(accepted, stride) << name_of_fourcc(p.fourcc); // the gap after the last row need not be there
        EXPECT_EQ(set_planes(f, p.fourcc, kSize, stride, Memory{std::span(b.data).first(all / 2)}).substr(0, 10),
                  "truncated:");
        EXPECT_NE(set_planes(f, p.fourcc, kSize, 3, Memory{std::span(b.data)}), ""); // rows that overlap
        EXPECT_NE(set_planes(f, p.fourcc, kSize, stride, {}), "");
    }
    Frame f;
    EXPECT_EQ(set_planes(f, fourcc("ABCD"), kSize, 8, {}), "its pixel format ABCD is not known here");
    EXPECT_NE(set_planes(f, fourcc("NV12"), {7, 4}, 8, Memory{}), "");
}

TEST(CameraPixels, JpegIsAsItCame)
{
    std::vector<uchar> bytes;
    cv::imencode(".jpg", noise(24, 32, CV_8UC3, 1), bytes);
    std::size_t const length = bytes.size();
    bytes.resize(length + 100); // the rest of the buffer
    Frame f;
    ASSERT_EQ(set_planes(f, fourcc("MJPG"), {32, 24}, 0, Memory{std::span<std::uint8_t const>(bytes)}), "");
    EXPECT_EQ(f.planes[0].data, bytes.data());
    EXPECT_EQ(rgb_of(f).size(), cv::Size(32, 24));
    EXPECT_NE(
        set_planes(f, fourcc("MJPG"), {32, 24}, 0, Memory{std::span<std::uint8_t const>(bytes).first(length - 1)}),
        "");
    EXPECT_EQ(set_planes(f, fourcc("MJPG"), {32, 24}, 0, Memory{std::span<std::uint8_t const>(bytes).subspan(2)}),
              "it is no JPEG");
}

} // namespace
} // namespace ar::test
