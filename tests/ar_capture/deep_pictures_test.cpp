// Pictures of 16 bits and OpenEXR as frames.

#include "ar/capture/picture_source.h"
#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "tests/ar_capture/temporary_folder.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

using namespace std::chrono_literals;

/// EXR of noise. @param layer  "color": the channels R, G, B without a layer
cv::Mat write_exr(std::filesystem::path const& file, gi::PixelType type, std::string const& layer = "color")
{
    cv::Mat radiance(24, 32, CV_32FC3);
    cv::RNG random{5};
    random.fill(radiance, cv::RNG::UNIFORM, -1, 40);
    gi::Picture picture{32, 24, {}, {}};
    gi::Layer& to = picture.add(layer, 3);
    std::copy_n(radiance.ptr<float>(), to.data.size(), to.data.begin());
    gi::Report report;
    gi::write_exr(file, picture, type, report);
    return radiance;
}

std::string refusal(std::filesystem::path const& folder)
{
    try {
        PictureSource const source(folder, {.pace = Pace::fastest});
        return source.counts().last_refusal;
    } catch (gi::InputError const& e) {
        return e.what();
    }
}

TEST(DeepPictures, Of16BitsKeepThem)
{
    for (char const* ending : {"png", "tiff"})
        for (int const type : {CV_16UC3, CV_16UC1}) {
            TemporaryFolder folder;
            cv::Mat const bgr = noise(24, 32, type, 3) * 251; // all bytes in use
            cv::imwrite(folder / fmt::format("1.{}", ending), bgr);
            PictureSource source(folder.path(), {.pace = Pace::fastest});
            auto const f = source.next(0ms);
            ASSERT_TRUE(f) << ending;
            EXPECT_EQ(f->format, PixelFormat::rgb16);
            cv::Mat rgb;
            cv::cvtColor(bgr, rgb, type == CV_16UC1 ? cv::COLOR_GRAY2RGB : cv::COLOR_BGR2RGB);
            EXPECT_TRUE(equal(picture_of(*f), rgb)) << ending;
            EXPECT_EQ(rgb_of(*f).type(), CV_8UC3);
            EXPECT_EQ(gray_of(*f).type(), CV_8UC1);
        }
}

TEST(DeepPictures, OfOpenExrAreRadiance)
{
    TemporaryFolder folder;
    cv::Mat const half = write_exr(folder / "1.exr", gi::PixelType::half);
    cv::Mat const single = write_exr(folder / "2.exr", gi::PixelType::single);
    PictureSource source(folder.path(), {.pace = Pace::fastest});
    auto const first = source.next(0ms), second = source.next(0ms);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->format, PixelFormat::rgb_linear);
    EXPECT_LT(cv::norm(picture_of(*first), half, cv::NORM_INF), 0.02);
    EXPECT_TRUE(equal(picture_of(*second), single));
    EXPECT_TRUE(equal(radiance_of(picture_of(*second), srgb_photometry(), {.time_s = 3}), single));
}

/// Changes a number of the header, x of the lower right corner of a window.
void change_window(std::filesystem::path const& file, std::string const& window, char to)
{
    std::string bytes = file_text(file);
    std::size_t const at = bytes.find(window + std::string("\0box2i\0", 7)) + window.size() + 7 + 4;
    bytes[at + 8] = to;
    write_file(file, bytes);
}

TEST(DeepPictures, OfOpenExrAreTheirDisplayWindow)
{
    TemporaryFolder folder;
    cv::Mat const all = write_exr(folder / "1.exr", gi::PixelType::single);
    write_exr(folder / "2.exr", gi::PixelType::single);
    change_window(folder / "1.exr", "displayWindow", 35); // 36 columns, 32 of them with data
    change_window(folder / "2.exr", "displayWindow", 35);
    PictureSource source(folder.path(), {.pace = Pace::fastest});
    auto const frame = source.next(0ms);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->size_px, glm::ivec2(36, 24));
    cv::Mat const picture = picture_of(*frame);
    EXPECT_TRUE(equal(picture(cv::Rect(0, 0, 32, 24)).clone(), all));
    EXPECT_EQ(cv::norm(picture(cv::Rect(32, 0, 4, 24))), 0);
    source.next(0ms);
    EXPECT_EQ(source.counts().changed, 2u);
    EXPECT_NE(source.counts().last_change.find("2.exr: its data window covers 32 x 24"), std::string::npos)
        << source.counts().last_change;
    gi::Report report;
    report_losses(source.counts(), source.state(), report);
    EXPECT_EQ(report.losses().at("frames not used as they are").count, 2u);
}

TEST(DeepPictures, ThatAreCutOrHaveOtherChannelsSayWhy)
{
    TemporaryFolder cut, named, mixed;
    write_exr(cut / "1.exr", gi::PixelType::half);
    std::string const bytes = file_text(cut / "1.exr");
    write_file(cut / "1.exr", bytes.substr(0, bytes.size() / 2));
    EXPECT_NE(refusal(cut.path()).find("1.exr"), std::string::npos) << refusal(cut.path());
    write_exr(named / "1.exr", gi::PixelType::half, "beauty");
    EXPECT_NE(refusal(named.path()).find("no channels R, G and B, or Y, without a layer (its layers: beauty)"),
              std::string::npos)
        << refusal(named.path());
    cv::imwrite(mixed / "1.png", noise(24, 32, CV_16UC3, 1));
    cv::imwrite(mixed / "2.png", noise(24, 32, CV_8UC3, 1));
    write_exr(mixed / "3.exr", gi::PixelType::half);
    PictureSource source(mixed.path(), {.pace = Pace::fastest});
    while (source.next(0ms)) {
    }
    EXPECT_EQ(source.counts().delivered, 1u);
    EXPECT_EQ(source.counts().refused, 2u);
    EXPECT_NE(source.counts().last_refusal.find("its pixels are rgb_linear, those of the first one were rgb16"),
              std::string::npos)
        << source.counts().last_refusal;
}

} // namespace
} // namespace ar::test
