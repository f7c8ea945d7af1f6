// Codecs that work without OpenCV's module, against that module.

#include "gi/image_io/small_codecs.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

namespace {

cv::Mat gradient(int type)
{
    cv::Mat image(37, 53, CV_MAKETYPE(CV_64F, CV_MAT_CN(type)));
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols * image.channels(); ++x)
            image.ptr<double>(y)[x] =
                0.5 + 0.25 * std::sin(x * 0.05) + 0.25 * std::cos(y * 0.1 + x % image.channels());
    image.convertTo(image, CV_MAT_DEPTH(type), CV_MAT_DEPTH(type) == CV_16U ? 65535 : 255);
    return image;
}

/// Greatest difference of two pictures; infinite if size or type differ.
double difference(cv::Mat const& a, cv::Mat const& b)
{
    if (a.size() != b.size() || a.type() != b.type()) return std::numeric_limits<double>::infinity();
    return cv::norm(a, b, cv::NORM_INF);
}

constexpr int kFlags[]{cv::IMREAD_UNCHANGED, cv::IMREAD_COLOR, cv::IMREAD_GRAYSCALE,
                       cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH};

TEST(SmallCodecs, ReadPngAndJpegAsOpenCvDoes)
{
    for (int const type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4})
        for (char const* const extension : {".png", ".jpg"}) {
            bool const is_jpeg = extension[1] == 'j';
            if (is_jpeg && type != CV_8UC1 && type != CV_8UC3) continue;
            std::vector<unsigned char> bytes;
            ASSERT_TRUE(cv::imencode(extension, gradient(type), bytes));
            for (int const flags : kFlags) {
                cv::Mat const ours = gi::decode_small(bytes, flags), theirs = cv::imdecode(bytes, flags);
                bool const mixes_channels =
                    flags == cv::IMREAD_GRAYSCALE; // with weights of its own, before rounding or after
                EXPECT_LE(difference(ours, theirs), is_jpeg          ? 3
                                                    : mixes_channels ? 1
                                                                     : 0)
                    << extension << ", type " << type << ", flags " << flags;
            }
        }
}

TEST(SmallCodecs, ShowsAJpegUpright)
{
    std::vector<unsigned char> plain;
    ASSERT_TRUE(cv::imencode(".jpg", gradient(CV_8UC3), plain));
    for (unsigned char orientation = 0; orientation <= 9; ++orientation)
        for (bool const is_little : {true, false}) {
            // A directory of one entry: tag 274, of type SHORT.
            std::string const place(1, char(orientation)), zero(1, '\0');
            using namespace std::string_literals;
            std::string const little = "II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0"s + place + zero;
            std::string const big = "MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01"s + zero + place;
            std::string const exif =
                "\xff\xe1\0\x22"s + "Exif\0\0"s + (is_little ? little : big) + std::string(6, '\0');
            std::string const jpeg(plain.begin(), plain.end()), text = jpeg.substr(0, 2) + exif + jpeg.substr(2);
            std::vector<unsigned char> const turned(text.begin(), text.end());
            for (int const flags : {int(cv::IMREAD_COLOR), cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION})
                EXPECT_LE(difference(gi::decode_small(turned, flags), cv::imdecode(turned, flags)), 3)
                    << int(orientation) << (is_little ? " little" : " big") << " flags " << flags;
        }
}

TEST(SmallCodecs, WritesWhatOpenCvReads)
{
    for (int const type : {CV_8UC1, CV_8UC3, CV_8UC4})
        for (char const* const extension : {".png", ".bmp", ".jpg"}) {
            if (type == CV_8UC4 && extension[1] != 'p') continue;
            auto const bytes = gi::encode_small(extension, gradient(type), 95);
            ASSERT_FALSE(bytes.empty()) << extension << " " << type;
            bool const is_jpeg = extension[1] == 'j';
            int const flags = type == CV_8UC1 ? cv::IMREAD_GRAYSCALE : cv::IMREAD_UNCHANGED;
            EXPECT_LE(difference(cv::imdecode(bytes, flags), gradient(type)), is_jpeg ? 8 : 0)
                << extension << " " << type;
        }
    EXPECT_TRUE(gi::encode_small(".tiff", gradient(CV_8UC3), 95).empty());
    EXPECT_TRUE(gi::encode_small(".png", gradient(CV_16UC3), 95).empty());
}

TEST(SmallCodecs, RefusesDamagedFiles)
{
    std::vector<unsigned char> bytes;
    ASSERT_TRUE(cv::imencode(".png", gradient(CV_8UC3), bytes));
    for (std::size_t const size : {std::size_t(0), std::size_t(1), std::size_t(8), bytes.size() / 2}) {
        std::vector<unsigned char> const cut(bytes.begin(), bytes.begin() + std::ptrdiff_t(size));
        EXPECT_TRUE(gi::decode_small(cut, cv::IMREAD_UNCHANGED).empty()) << size;
    }
    for (char const* const extension :
         {".hdr", ".tiff", ".ppm"}) { // others that stb could read, or that nothing here reads
        cv::Mat image = gradient(CV_8UC3);
        if (extension[1] == 'h') image.convertTo(image, CV_32F);
        ASSERT_TRUE(cv::imencode(extension, image, bytes));
        EXPECT_TRUE(gi::decode_small(bytes, cv::IMREAD_COLOR).empty()) << extension;
    }
}

} // namespace
