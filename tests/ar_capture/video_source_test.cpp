#include "ar/capture/counter_source.h"
#include "ar/capture/video_source.h"
#include "gi/core/error.h"
#include "tests/ar_capture/temporary_folder.h"

#include <fmt/format.h>
#include <opencv2/videoio.hpp>
#include <thread>
#include <unistd.h>

namespace ar::test {
namespace {

using namespace std::chrono_literals;
using Kind = SourceState::Kind;

/// FFV1 in AVI, lossless.
void film(std::string const& file, int frames)
{
    CounterSource counter({.size_px = {208, 120}, .pace = Pace::fastest});
    cv::VideoWriter writer(file, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('F', 'F', 'V', '1'), 30, {208, 120});
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < frames; ++i) writer.write(counter.next(0ms)->planes[0]);
}

std::vector<std::optional<std::uint32_t>> play(FrameSource& source)
{
    std::vector<std::optional<std::uint32_t>> numbers;
    while (source.state().kind == Kind::running)
        if (auto const f = source.next(5s)) numbers.push_back(read_counter(f->planes[0]));
    return numbers;
}

TEST(Video, EveryFrameComesInOrder)
{
    TemporaryFolder folder;
    film(folder / "v.avi", 20);
    auto const source = open_video(folder / "v.avi", Pace::fastest);
    EXPECT_EQ(source->description().frames_per_s, 30);
    EXPECT_EQ(source->description().size_px, glm::ivec2(208, 120));
    auto const numbers = play(*source);
    ASSERT_EQ(numbers.size(), 20u);
    for (std::uint32_t i = 0; i < 20; ++i) EXPECT_EQ(numbers[i], i);
    EXPECT_EQ(source->counts(), (SourceCounts{.delivered = 20}));
    EXPECT_EQ(source->state().kind, Kind::ended);
}

TEST(Video, PlaysAtItsOwnPace)
{
    TemporaryFolder folder;
    film(folder / "v.avi", 4);
    auto const source = open_video(folder / "v.avi");
    auto const first = source->next(0ms);
    ASSERT_TRUE(first);
    for (int i = 1; i < 4; ++i) {
        auto const f = source->next(5s);
        ASSERT_TRUE(f);
        EXPECT_NEAR(f->captured_s - first->captured_s, i / 30.0, 1e-6);
        EXPECT_GE(f->arrived_s, f->captured_s);
    }
}

TEST(Video, TruncatedItSaysWhatIsMissing)
{
    TemporaryFolder folder;
    film(folder / "v.avi", 20);
    std::string const whole = file_text(folder / "v.avi");
    int opened = 0;
    for (int part = 0; part < 20; ++part) {
        write_file(folder / "cut.avi", whole.substr(0, whole.size() * std::size_t(part) / 20));
        try {
            auto const source = open_video(folder / "cut.avi", Pace::fastest);
            auto const numbers = play(*source);
            SourceCounts const counts = source->counts();
            EXPECT_EQ(counts.delivered, numbers.size());
            if (counts.delivered < 19) {
                EXPECT_EQ(counts.delivered + counts.refused, 20u) << part;
            }
            ++opened;
        } catch (gi::InputError const&) {
        }
    }
    EXPECT_GT(opened, 10);
}

TEST(Video, CorruptItIsSurvived)
{
    TemporaryFolder folder;
    film(folder / "v.avi", 20);
    std::string const whole = file_text(folder / "v.avi");
    cv::RNG rng(5);
    for (int trial = 0; trial < 10; ++trial) {
        std::string spoilt = whole;
        for (int i = 0; i < 200; ++i)
            spoilt[std::size_t(rng.uniform(6000, int(spoilt.size())))] = char(rng.uniform(0, 256));
        write_file(folder / "spoilt.avi", spoilt);
        auto const source = open_video(folder / "spoilt.avi", Pace::fastest);
        play(*source);
        EXPECT_EQ(source->state().kind, Kind::ended);
        EXPECT_GE(source->counts().delivered + source->counts().refused, 19u);
    }
}

TEST(Video, ThatIsNoneIsAnInputError)
{
    TemporaryFolder folder;
    write_file(folder / "empty.avi", "");
    write_file(folder / "text.mp4", "no video at all");
    for (char const* name : {"empty.avi", "text.mp4", "missing.avi"})
        EXPECT_THROW(open_video(folder / name), gi::InputError) << name;
    EXPECT_THROW(open_video(folder.path()), gi::InputError);
}

TEST(Device, ThatIsNotThereIsAnInputError)
{
    EXPECT_THROW(open_device(-1), gi::InputError);
    EXPECT_THROW(open_device(999), gi::InputError);
    EXPECT_THROW(open_device(0, {.format = PixelFormat::nv12}), gi::InputError);
}

class Pipeline : public ::testing::Test {
protected:
    void SetUp() override
    {
        cv::VideoCapture tried("videotestsrc num-buffers=1 ! videoconvert ! appsink", cv::CAP_GSTREAMER);
        if (!tried.isOpened())
            GTEST_SKIP() << "SKIPPED: GStreamer has no videotestsrc here (gstreamer1.0-plugins-base)";
    }
};

TEST_F(Pipeline, DeliversAndEnds)
{
    auto const source =
        open_pipeline("videotestsrc num-buffers=12 ! video/x-raw,format=BGR,width=320,height=240 ! appsink",
                      {.delivery = Delivery::every});
    std::uint64_t frames = 0;
    while (source->state().kind == Kind::running)
        if (auto const f = source->next(5s)) {
            EXPECT_EQ(f->sequence, frames++);
            EXPECT_EQ(f->format, PixelFormat::bgr8);
            EXPECT_EQ(f->origin, TimestampOrigin::arrival);
            EXPECT_EQ(f->size_px, glm::ivec2(320, 240));
        }
    EXPECT_EQ(frames, 12u);
    EXPECT_EQ(source->counts(), (SourceCounts{.delivered = 12}));
    EXPECT_FALSE(source->state().reason.empty());
    EXPECT_EQ(source->set({.gain = 2.0}).size(), 1u);
}

TEST_F(Pipeline, TheNewestComesAndOlderOnesAreDropped)
{
    auto const source = open_pipeline("videotestsrc is-live=true num-buffers=60 ! "
                                      "video/x-raw,format=GRAY8,width=320,height=240,framerate=60/1 ! appsink");
    for (int i = 0; i < 1000 && source->counts().dropped == 0; ++i) std::this_thread::sleep_for(10ms);
    auto const f = source->next(5s);
    ASSERT_TRUE(f);
    EXPECT_EQ(f->format, PixelFormat::gray8);
    EXPECT_EQ(source->counts().delivered, 1u);
    EXPECT_GE(source->counts().dropped, f->sequence); // all before it, and maybe more since
    EXPECT_GT(f->sequence, 0u);
}

TEST_F(Pipeline, ThatBreaksOffIsLost)
{
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    std::thread camera([&] { // that is unplugged within its sixth frame
        std::vector<char> const bytes(64 * 48 * 11 / 2, 100);
        ssize_t const n = ::write(ends[1], bytes.data(), bytes.size());
        EXPECT_EQ(n, ssize_t(bytes.size()));
        ::close(ends[1]);
    });
    auto const source = open_pipeline(fmt::format("fdsrc fd={} ! rawvideoparse width=64 height=48 format=gray8 "
                                                  "framerate=30/1 ! appsink",
                                                  ends[0]),
                                      {.delivery = Delivery::every});
    std::uint64_t frames = 0;
    while (source->state().kind == Kind::running) frames += source->next(5s).has_value();
    camera.join();
    ::close(ends[0]);
    EXPECT_EQ(frames, 5u);
    EXPECT_EQ(source->state().kind, Kind::lost);
    EXPECT_EQ(source->state().reason, "the pipeline stopped");
}

TEST_F(Pipeline, ThatCannotBeBuiltIsAnInputError)
{
    EXPECT_THROW(open_pipeline("nosuchelement ! appsink"), gi::InputError);
    EXPECT_THROW(open_pipeline("videotestsrc num-buffers=0 ! appsink"), gi::InputError);
}

} // namespace
} // namespace ar::test
