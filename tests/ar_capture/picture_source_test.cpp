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
    EXPECT_EQ(source.counts(), (SourceCounts{.delivered = 3, .dropped = 7, .missing = "3 to 9"}));
}

TEST(Pictures, OfAPatternHaveTheirNumbersAndGapsAreDropped)
{
    TemporaryFolder folder;
    for (int i : {3, 4, 7, 12}) cv::imwrite(folder / fmt::format("f_{:04}.png", i), noise(24, 32, CV_8UC1, i));
    cv::imwrite(folder / "f_5.png", noise(24, 32, CV_8UC1, 0)); // not as %04d writes it
    PictureSource source(folder / "f_%04d.png", {.pace = Pace::fastest});
    EXPECT_EQ(source.description().format, PixelFormat::gray8);
    EXPECT_EQ(play(source), (std::vector<std::uint64_t>{3, 4, 7, 12}));
    EXPECT_EQ(source.counts(), (SourceCounts{.delivered = 4, .dropped = 6, .missing = "5 to 6, 8 to 11"}));
    EXPECT_THROW(find_pictures(folder / "f_%s.png"), gi::InputError);
    EXPECT_THROW(find_pictures(folder / "f_%d_%d.png"), gi::InputError);
    EXPECT_THROW(find_pictures(folder / "f_%"), gi::InputError);
}

TEST(Pictures, OfAFolderHaveTheNumberInWhichTheirNamesDiffer)
{
    struct Case {
        std::vector<std::string> files;
        std::vector<std::uint64_t> numbers;
        std::string missing;
        bool has_numbers = true;
        std::vector<std::string> left_out = {};
    };
    std::vector<Case> const cases{
        {{"000000.png", "000001.png", "000003.png"}, {0, 1, 3}, "2"},
        {{"9.png", "10.png", "8.png"}, {8, 9, 10}, ""},
        {{"099.png", "100.png", "101.png"}, {99, 100, 101}, ""},
        {{"1.png", "2.png", "3.png"}, {1, 2, 3}, ""},
        {{"100.png", "102.png", "105.png"}, {100, 102, 105}, "101, 103 to 104"},
        {{"f_1.png", "f_2.jpg", "f_03.PNG"}, {1, 2, 3}, ""},
        {{"cam2_001.png", "cam2_002.png", "cam2_004.png"}, {1, 2, 4}, "3"},
        {{"take_3_v2.png", "take_4_v2.png", "take_6_v2.png"}, {3, 4, 6}, "5"},
        {{"0.png", "1.png", "2.png", "cover.png"}, {0, 1, 2}, "", true, {"cover.png"}},
        {{"f_0.png", "f_1.png", "f_2.png", "f_1 copy.png"}, {0, 1, 2}, "", true, {"f_1 copy.png"}},
        {{"7.png"}, {7}, ""},
        {{"a.png", "b.png", "c.png"}, {0, 1, 2}, "", false},
        {{"left_1.png", "right_1.png", "left_2.png", "right_2.png"}, {0, 1, 2, 3}, "", false},
        {{"1403636579763555584.png", "1403636579813555456.png"}, {0, 1}, "", false},
        {{"1305031102.175304.png", "1305031102.211214.png", "1305031103.2.png"}, {0, 1, 2}, "", false},
        {{"99999999999999999999998.png", "99999999999999999999999.png"}, {0, 1}, "", false},
    };
    for (Case const& c : cases) {
        TemporaryFolder folder;
        for (std::string const& name : c.files) write_file(folder / name, "");
        write_file(folder / "notes_12.txt", "no picture");
        FoundPictures const found = find_pictures(folder.path());
        std::vector<std::uint64_t> numbers;
        for (NumberedPicture const& p : found.pictures) numbers.push_back(p.number);
        std::vector<std::string> left_out;
        for (auto const& file : found.left_out) left_out.push_back(file.filename().string());
        EXPECT_EQ(numbers, c.numbers) << c.files[0];
        EXPECT_EQ(found.has_numbers, c.has_numbers) << c.files[0];
        EXPECT_EQ(left_out, c.left_out) << c.files[0];
        EXPECT_EQ(missing_numbers(found.pictures), c.missing) << c.files[0];
        EXPECT_EQ(found.why_not.empty(), c.has_numbers || c.files[0] == "a.png") << c.files[0];
    }
}

TEST(Pictures, OfOneNumberTwiceAreRefused)
{
    for (auto const& [a, b] : std::vector<std::pair<std::string, std::string>>{
             {"3.png", "3.jpg"}, {"3.png", "03.png"}, {"f_003.png", "f_3.exr"}}) {
        for (bool const alone : {true, false}) {
            TemporaryFolder folder;
            write_file(folder / a, "");
            write_file(folder / b, "");
            std::string const before = a.starts_with("f_") ? "f_" : "";
            if (!alone) write_file(folder / (before + "4.png"), "");
            try {
                find_pictures(folder.path());
                FAIL() << a << " " << b;
            } catch (gi::InputError const& e) {
                EXPECT_NE(std::string(e.what()).find("have the number 3"), std::string::npos) << e.what();
                EXPECT_NE(std::string(e.what()).find(b), std::string::npos) << e.what();
            }
        }
    }
}

TEST(Pictures, AreTimedByTheNumberOfTheFirst)
{
    TemporaryFolder folder;
    for (int i : {2, 3, 5}) cv::imwrite(folder / fmt::format("{:06}.png", i), noise(24, 32, CV_8UC3, i));
    PictureSource source(folder.path(), {.pace = Pace::fastest, .first = 0});
    EXPECT_EQ(play(source), (std::vector<std::uint64_t>{2, 3, 5}));
    EXPECT_EQ(source.counts(), (SourceCounts{.delivered = 3, .dropped = 3, .missing = "0 to 1, 4"}));
    EXPECT_EQ(source.description().first, 0u);

    TemporaryFolder letters;
    cv::imwrite(letters / "a.png", noise(24, 32, CV_8UC3, 1));
    EXPECT_THROW(PictureSource(letters.path(), {.first = 0}), gi::InputError);
}

TEST(Pictures, WithoutANumberBesideNumberedOnesAreRefused)
{
    TemporaryFolder folder;
    for (int i = 0; i < 3; ++i) cv::imwrite(folder / fmt::format("{}.png", i), noise(24, 32, CV_8UC3, i));
    cv::imwrite(folder / "cover.png", noise(24, 32, CV_8UC3, 9));
    PictureSource source(folder.path(), {.pace = Pace::fastest});
    EXPECT_EQ(play(source), (std::vector<std::uint64_t>{0, 1, 2}));
    EXPECT_EQ(source.counts().refused, 1u);
    EXPECT_NE(source.counts().last_refusal.find("cover.png"), std::string::npos);
    gi::Report report;
    report_counts(source.counts(), report);
    EXPECT_EQ(report.losses().at("frames that could not be read").count, 1u);
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
