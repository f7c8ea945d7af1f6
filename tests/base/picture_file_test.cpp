#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/rng.h"
#include "gi/image_io/picture_file.h"
#include "tests/support/data.h"

#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

/// Of this process alone: tests run side by side.
fs::path scratch(std::string const& name)
{
    return fs::path(testing::TempDir()) / ("lightwell_" + std::to_string(getpid()) + "_" + name);
}

Picture sample_picture(int width, int height)
{
    Picture p;
    p.width = width;
    p.height = height;
    Pcg32 rng(5, 5);
    for (auto const& [name, channels] : {std::pair{"color", 3}, std::pair{"L1", 3}, std::pair{"depth", 1},
                                         std::pair{"normal", 3}, std::pair{"variance", 3}})
        for (float& v : p.add(name, channels).data) v = rng.uniform() * 10 - 1;
    p.metadata = {{"seed", "7"}, {"command", "lightwell render"}};
    return p;
}

TEST(Exr, RoundTripsAllLayersExactly)
{
    Picture const p = sample_picture(13, 7);
    Report report;
    for (ExrCompression const compression : {ExrCompression::zip, ExrCompression::none}) {
        write_exr(scratch("a.exr"), p, PixelType::single, report, {.compression = compression});
        Picture const q = read_exr(scratch("a.exr"));
        ASSERT_EQ(q.width, 13);
        ASSERT_EQ(q.height, 7);
        EXPECT_EQ(q.metadata, p.metadata);
        ASSERT_EQ(q.layers.size(), p.layers.size());
        for (Layer const& l : p.layers) {
            Layer const* const m = q.find(l.name);
            ASSERT_NE(m, nullptr) << l.name;
            EXPECT_EQ(m->channels, l.channels);
            EXPECT_EQ(m->data, l.data) << l.name;
        }
    }
    EXPECT_TRUE(report.losses().empty());
}

TEST(Exr, HalfClampsAndCountsButKeepsDepthSingle)
{
    Picture p = sample_picture(8, 8);
    p.find("color")->data[0] = 1e6f;
    p.find("color")->data[4] = std::nanf("");
    p.find("depth")->data[0] = 123456.789f;
    Report report;
    write_exr(scratch("h.exr"), p, PixelType::half, report);
    Picture const q = read_exr(scratch("h.exr"));
    EXPECT_EQ(q.find("color")->data[0], 65504.0f);
    EXPECT_TRUE(std::isnan(q.find("color")->data[4]));
    EXPECT_NEAR(q.find("color")->data[1], p.find("color")->data[1], 0.01);
    EXPECT_EQ(q.find("depth")->data, p.find("depth")->data);
    EXPECT_EQ(q.find("variance")->data, p.find("variance")->data);
    EXPECT_EQ(report.losses().at("values clamped to half float").count, 1u);
}

TEST(Exr, SamePictureSameBytes)
{
    Report report;
    write_exr(scratch("b1.exr"), sample_picture(9, 9), PixelType::single, report);
    write_exr(scratch("b2.exr"), sample_picture(9, 9), PixelType::single, report);
    EXPECT_EQ(read_bytes(scratch("b1.exr")), read_bytes(scratch("b2.exr")));
}

TEST(Exr, TruncatedAndDamagedFilesAreInputErrors)
{
    Report report;
    write_exr(scratch("t.exr"), sample_picture(16, 16), PixelType::half, report);
    auto const bytes = read_bytes(scratch("t.exr"));
    for (std::size_t n = 0; n < bytes.size() - 1; n += 61)
        EXPECT_THROW(decode_picture({bytes.data(), n}, "t"), InputError) << n;
    Pcg32 rng(9, 9);
    for (int i = 0; i < 300; ++i) {
        auto damaged = bytes;
        for (int k = 0; k < 8; ++k) damaged[rng.next() % damaged.size()] = static_cast<unsigned char>(rng.next());
        try {
            decode_picture(damaged, "d");
        } catch (InputError const&) {
        }
    }
}

TEST(Hdr, ReadsFlatAndRunLengthEncodedPixels)
{
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    text += std::string("\x80\x40\x20\x81", 4) + std::string("\x80\x00\x00\x80", 4);
    Picture const p = decode_picture({reinterpret_cast<unsigned char const*>(text.data()), text.size()}, "x.hdr");
    ASSERT_EQ(p.width, 2);
    EXPECT_EQ(p.layers[0].data, (std::vector<float>{1, 0.5f, 0.25f, 0.5f, 0, 0}));

    text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n" + std::string("\x02\x02\x00\x08", 4);
    for (char const c : {'\x40', '\x20', '\x10', '\x80'}) text += std::string("\x88", 1) + c;
    Picture const q = decode_picture({reinterpret_cast<unsigned char const*>(text.data()), text.size()}, "x.hdr");
    EXPECT_EQ(q.layers[0].data[21], 0.25f);
    EXPECT_THROW(decode_hdr({reinterpret_cast<unsigned char const*>(text.data()), text.size() - 1}, "x"),
                 InputError);
}

TEST(Hdr, UndoesTheExposuresOfItsHeader)
{
    std::string const text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=4\nEXPOSURE= 0.5\nCOLORCORR=1 2 4\n\n"
                             "-Y 1 +X 1\n" +
                             std::string("\x80\x80\x80\x82", 4);
    Picture const p = decode_picture({reinterpret_cast<unsigned char const*>(text.data()), text.size()}, "x.hdr");
    EXPECT_EQ(rgb(*p.find("color"), 0), (vec3{2.0f / 2, 2.0f / 4, 2.0f / 8}));
    std::string const dark = "#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n" + std::string("\x80\x80\x80\x82", 4);
    EXPECT_THROW(decode_hdr({reinterpret_cast<unsigned char const*>(dark.data()), dark.size()}, "x"), InputError);
    std::string const huge = "#?RADIANCE\n\n-Y 65536 +X 65536\n" + std::string(std::size_t(9) << 20, '\1');
    EXPECT_THROW(decode_hdr({reinterpret_cast<unsigned char const*>(huge.data()), huge.size()}, "x"), InputError);
}

TEST(Png, RoundTripsThroughTheSrgbCurve)
{
    std::vector<unsigned char> const pixels{0, 128, 255, 10, 20, 30};
    write_png(scratch("p.png"), 2, 1, pixels);
    Picture const p = read_picture(scratch("p.png"));
    EXPECT_NEAR(p.layers[0].data[1], 0.215861, 1e-5);
    EXPECT_NEAR(p.layers[0].data[2], 1, 1e-6);
    EXPECT_THROW(read_picture(scratch("missing.png")), InputError);
}

std::vector<unsigned char> encoded(char const* extension, cv::Mat const& picture,
                                   std::vector<int> const& settings = {})
{
    std::vector<unsigned char> bytes;
    cv::imencode(extension, picture, bytes, settings);
    return bytes;
}

TEST(Pictures, DropAlphaAndReadSixteenBits)
{
    Picture const p =
        decode_picture(encoded(".png", cv::Mat(2, 3, CV_8UC4, cv::Scalar(0, 128, 255, 10))), "a.png");
    ASSERT_EQ(p.layers.size(), 1u);
    ASSERT_EQ(p.layers[0].channels, 3);
    EXPECT_NEAR(p.layers[0].data[0], 1, 1e-6);
    EXPECT_NEAR(p.layers[0].data[1], 0.215861, 1e-5);
    Picture const q = decode_picture(encoded(".png", cv::Mat(2, 3, CV_16UC1, cv::Scalar(32768))), "b.png");
    EXPECT_NEAR(q.layers[0].data[2], 0.214049, 1e-5);
    Picture const t = decode_picture(
        encoded(".tiff", cv::Mat(2, 3, CV_32FC3, cv::Scalar(1, 2, 40)), {cv::IMWRITE_TIFF_COMPRESSION, 1}),
        "c.tiff");
    EXPECT_EQ(t.layers[0].data[0], 40);
}

TEST(Pictures, DamagedOrUnknownBytesAreInputErrors)
{
    cv::Mat const picture(16, 16, CV_8UC3, cv::Scalar(10, 120, 230));
    Pcg32 rng(8, 8);
    testing::internal::CaptureStderr(); // OpenCV and libpng complain there
    for (char const* extension : {".png", ".jpg", ".tiff", ".bmp", ".webp"}) {
        auto const bytes = encoded(extension, picture);
        ASSERT_EQ(decode_picture(bytes, extension).width, 16);
        for (int i = 0; i < 60; ++i) {
            auto damaged = bytes;
            damaged.resize(1 + rng.next() % damaged.size());
            for (int k = 0; k < 4; ++k)
                damaged[rng.next() % damaged.size()] = static_cast<unsigned char>(rng.next());
            try {
                decode_picture(damaged, extension);
            } catch (InputError const&) {
            }
        }
    }
    testing::internal::GetCapturedStderr();
    for (char const* text : {"", "P6 1 1 255 abc", "<svg/>", "RIFF", "#?", "#?RADIANCE\n\n-Y 60000 +X 60000\n"})
        EXPECT_THROW(decode_picture({reinterpret_cast<unsigned char const*>(text), std::strlen(text)}, "t"),
                     InputError)
            << text;
}

TEST(Pictures, AJpegThatAnnouncesAGigapixelIsRefusedAtOnce)
{
    auto bytes = encoded(".jpg", cv::Mat(16, 16, CV_8UC3, cv::Scalar(1, 2, 3)));
    std::size_t at = 2;
    while (bytes[at + 1] != 0xc0) at += 2 + std::size_t(bytes[at + 2]) * 256 + bytes[at + 3];
    bytes[at + 5] = bytes[at + 7] = 0x7d;
    EXPECT_THROW(decode_picture(bytes, "x.jpg"), InputError);
}

TEST(WriteByRename, LeavesTheOldFileWhenWritingFails)
{
    fs::path const file = scratch("r.txt");
    write_text(file, "old");
    EXPECT_THROW(write_by_rename(file,
                                 [](fs::path const& t) {
                                     std::ofstream(t) << "half";
                                     throw std::runtime_error("broken");
                                 }),
                 InputError);
    auto const bytes = read_bytes(file);
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "old");
    for (auto const& entry : fs::directory_iterator(file.parent_path()))
        EXPECT_EQ(entry.path().filename().string().find("." + file.filename().string() + ".tmp"),
                  std::string::npos);
    EXPECT_THROW(write_text(scratch("no_such_folder") / "f", "x"), InputError);
    EXPECT_THROW(write_text("/dev/null", "x"), InputError); // a rename would put a file there
    EXPECT_THROW(write_text(file.parent_path(), "x"), InputError);
}

TEST(WriteByRename, NamesAFullDisk)
{
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "SKIPPED: there is no /dev/full";
    try {
        write_by_rename(scratch("full.txt"), [](fs::path const&) {
            std::ofstream out("/dev/full");
            out.exceptions(std::ios::failbit | std::ios::badbit);
            out << "x" << std::flush;
        });
        FAIL();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("No space left on device"), std::string::npos) << e.what();
    }
    EXPECT_FALSE(fs::exists(scratch("full.txt")));
}

TEST(SharedData, HardPicturesAndLightProbesAreRead)
{
    LIGHTWELL_NEED_DATA(shared_data() / "envmaps");
    int read = 0;
    for (fs::path const& folder : {shared_data() / "envmaps", shared_data() / "hard_meshes" / "exr"})
        for (auto const& entry : fs::directory_iterator(folder)) {
            SCOPED_TRACE(entry.path().string());
            Picture p;
            EXPECT_NO_THROW(p = read_picture(entry.path()));
            EXPECT_GT(p.pixels(), 0u);
            ++read;
        }
    EXPECT_GE(read, 14);
}

} // namespace
} // namespace gi::test
