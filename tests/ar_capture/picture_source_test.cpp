#include "ar/capture/picture_source.h"
#include "ar/capture/whole_picture.h"
#include "gi/core/error.h"
#include "tests/ar_capture/temporary_folder.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace ar::test {
namespace {

using namespace std::chrono_literals;

std::vector<std::uint64_t> play(PictureSource& source)
{
    std::vector<std::uint64_t> numbers;
    while (source.state().kind == SourceState::Kind::running)
        if (auto const f = source.next(1000ms)) numbers.push_back(f->sequence);
    return numbers;
}

TEST(Pictures, AreSortedAsPeopleCount)
{
    EXPECT_TRUE(is_before_naturally("a2", "a10"));
    EXPECT_FALSE(is_before_naturally("a10", "a2"));
    EXPECT_TRUE(is_before_naturally("a02", "a10"));
    EXPECT_TRUE(is_before_naturally("a1b3", "a1b20"));
    EXPECT_TRUE(is_before_naturally("a", "a1"));
    EXPECT_TRUE(is_before_naturally("007", "7") != is_before_naturally("7", "007"));
    EXPECT_FALSE(is_before_naturally("x", "x"));
    EXPECT_TRUE(is_before_naturally("99999999999999999999998", "99999999999999999999999"));
}

TEST(Pictures, OfAFolderComeInOrderAndUnchanged)
{
    TemporaryFolder folder;
    for (int i : {10, 2, 1}) cv::imwrite(folder / fmt::format("shot{}.png", i), noise(24, 32, CV_8UC3, i));
    write_file(folder / "notes.txt", "no picture");
    PictureSource source(folder.path(), {.pace = Pace::fastest});
    for (int i : {1, 2, 10}) {
        auto const f = source.next(0ms);
        ASSERT_TRUE(f);
        EXPECT_TRUE(equal(f->planes[0], noise(24, 32, CV_8UC3, i)));
        EXPECT_EQ(f->format, PixelFormat::bgr8);
        EXPECT_EQ(f->origin, TimestampOrigin::file);
    }
    EXPECT_FALSE(source.next(0ms));
    EXPECT_EQ(source.state().kind, SourceState::Kind::ended);
    EXPECT_EQ(source.counts(), (SourceCounts{.delivered = 3}));
}

TEST(Pictures, OfAPatternHaveTheirNumbersAndGapsAreDropped)
{
    TemporaryFolder folder;
    for (int i : {3, 4, 7, 12}) cv::imwrite(folder / fmt::format("f_{:04}.png", i), noise(24, 32, CV_8UC1, i));
    cv::imwrite(folder / "f_5.png", noise(24, 32, CV_8UC1, 0)); // not as %04d writes it
    PictureSource source(folder / "f_%04d.png", {.pace = Pace::fastest});
    EXPECT_EQ(source.description().format, PixelFormat::gray8);
    EXPECT_EQ(play(source), (std::vector<std::uint64_t>{3, 4, 7, 12}));
    EXPECT_EQ(source.counts(), (SourceCounts{.delivered = 4, .dropped = 6}));
    EXPECT_THROW(find_pictures(folder / "f_%s.png"), gi::InputError);
    EXPECT_THROW(find_pictures(folder / "f_%d_%d.png"), gi::InputError);
    EXPECT_THROW(find_pictures(folder / "f_%"), gi::InputError);
}

TEST(Pictures, ThatAreSpoiltAreRefusedAndNamed)
{
    TemporaryFolder folder;
    for (int i = 0; i < 7; ++i) cv::imwrite(folder / fmt::format("{}.png", i), noise(24, 32, CV_8UC3, i));
    std::string const text = file_text(folder / "1.png");
    write_file(folder / "1.png", text.substr(0, text.size() / 2));
    cv::imwrite(folder / "2.png", noise(20, 32, CV_8UC3, 2));
    write_file(folder / "3.png", "");
    write_file(folder / "4.png", "hello");
    cv::imwrite(folder / "5.png", noise(24, 32, CV_8UC1, 5));
    std::vector<std::pair<std::uint64_t, std::string>> const reasons{
        {1, "1.png: the PNG ends within a chunk"},
        {2, "2.png: it has 32 x 20 pixels, the first one had 32 x 24"},
        {3, "3.png: it is empty"},
        {4, "4.png: it is no picture that is known here"},
        {5, "5.png: it has colour where the first one had none, or none where it had"}};
    PictureSource source(folder.path(), {.pace = Pace::fastest});
    EXPECT_EQ(play(source), (std::vector<std::uint64_t>{0, 6}));
    EXPECT_EQ(source.counts().refused, 5u);
    EXPECT_EQ(source.counts().dropped, 0u);
    EXPECT_EQ(source.counts().last_refusal, reasons.back().second);
    for (auto const& [spoilt, reason] : reasons) { // each of them alone
        TemporaryFolder pair;
        std::filesystem::copy(folder / "0.png", pair / "0.png");
        std::filesystem::copy(folder / fmt::format("{}.png", spoilt), pair / fmt::format("{}.png", spoilt));
        PictureSource alone(pair.path(), {.pace = Pace::fastest});
        EXPECT_EQ(play(alone).size(), 1u);
        EXPECT_EQ(alone.counts().last_refusal, reason);
    }
}

TEST(Pictures, ThatVanishMeanwhileAreRefused)
{
    TemporaryFolder folder;
    for (int i = 0; i < 4; ++i) cv::imwrite(folder / fmt::format("{}.png", i), noise(24, 32, CV_8UC3, i));
    PictureSource source(folder.path(), {.pace = Pace::fastest});
    ASSERT_TRUE(source.next(0ms));
    for (int i : {1, 2}) std::filesystem::remove(folder / fmt::format("{}.png", i));
    EXPECT_EQ(play(source), (std::vector<std::uint64_t>{3}));
    EXPECT_EQ(source.counts().refused, 2u);
    EXPECT_EQ(source.counts().last_refusal, "2.png: No such file or directory");
}

TEST(Pictures, WithoutAnyThatIsGoodAreAnInputError)
{
    TemporaryFolder folder;
    EXPECT_THROW(PictureSource(folder.path()), gi::InputError);
    EXPECT_THROW(PictureSource(folder / "missing"), gi::InputError);
    write_file(folder / "0.jpg", "no picture");
    try {
        PictureSource source(folder.path());
        FAIL();
    } catch (gi::InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("0.jpg: it is no picture that is known here"), std::string::npos)
            << e.what();
    }
}

TEST(Pictures, PlayAtTheirOwnPace)
{
    TemporaryFolder folder;
    for (int i = 0; i < 5; ++i) cv::imwrite(folder / fmt::format("{}.png", i), noise(24, 32, CV_8UC3, i));
    PictureSource source(folder.path(), {.frames_per_s = 50});
    auto const first = source.next(0ms);
    ASSERT_TRUE(first);
    for (int i = 1; i < 5; ++i) {
        auto const f = source.next(1000ms);
        ASSERT_TRUE(f);
        EXPECT_NEAR(f->captured_s - first->captured_s, i / 50.0, 1e-9);
        EXPECT_GE(f->arrived_s, f->captured_s);
    }
}

TEST(Pictures, AreNotWaitedForLongerThanAllowed)
{
    TemporaryFolder folder;
    for (int i = 0; i < 2; ++i) cv::imwrite(folder / fmt::format("{}.png", i), noise(24, 32, CV_8UC3, i));
    PictureSource source(folder.path(), {.frames_per_s = 0.01});
    EXPECT_TRUE(source.next(0ms));
    EXPECT_FALSE(source.next(1ms)); // in 100 s
    EXPECT_EQ(source.state().kind, SourceState::Kind::running);
}

TEST(WholePicture, EveryTruncationIsSeen)
{
    for (char const* kind : {".png", ".jpg"}) {
        std::vector<uchar> bytes;
        cv::imencode(kind, noise(24, 32, CV_8UC3, 1), bytes);
        EXPECT_EQ(what_is_missing(bytes), "");
        for (std::size_t n = 8; n < bytes.size(); ++n)
            ASSERT_NE(what_is_missing(std::span(bytes).first(n)), "") << kind << " " << n;
        bytes.resize(bytes.size() + 1000); // as cameras pad
        EXPECT_EQ(what_is_missing(bytes), "");
    }
    EXPECT_EQ(what_is_missing({}), "");
}

TEST(WholePicture, EveryKindThatIsReadIsKnown)
{
    for (char const* kind : {".png", ".jpg", ".bmp", ".tif", ".ppm", ".webp"}) {
        std::vector<uchar> bytes;
        cv::imencode(kind, noise(24, 32, CV_8UC3, 1), bytes);
        EXPECT_TRUE(is_picture(bytes)) << kind;
    }
    std::vector<uchar> dicom(300);
    std::copy_n("DICM", 4, dicom.begin() + 128);
    EXPECT_FALSE(is_picture(dicom));
    EXPECT_FALSE(is_picture({}));
}

TEST(WholePicture, ProgressiveAndRestartingJpegAreWhole)
{
    for (auto const& options :
         {std::vector<int>{cv::IMWRITE_JPEG_PROGRESSIVE, 1}, std::vector<int>{cv::IMWRITE_JPEG_RST_INTERVAL, 2}}) {
        std::vector<uchar> bytes;
        cv::imencode(".jpg", noise(40, 40, CV_8UC3, 1), bytes, options);
        EXPECT_EQ(what_is_missing(bytes), "");
        EXPECT_NE(what_is_missing(std::span(bytes).first(bytes.size() - 2)), "");
    }
}

} // namespace
} // namespace ar::test
