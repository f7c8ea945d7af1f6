#include "viewer/offline/video_writer.h"

#include "gi/core/error.h"
#include "tests/viewer/run_program.h"

#include <csignal>
#include <cstdlib>
#include <opencv2/videoio.hpp>
#include <sys/resource.h>

namespace viewer::test {
namespace {

constexpr int kWidth = 64, kHeight = 48, kFrames = 7;

/// A bar that moves, on a ramp.
std::vector<unsigned char> frame(int k)
{
    std::vector<unsigned char> rgb;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int const v : {x / 8 == k ? 255 : 20, 4 * x, 5 * y}) rgb.push_back(static_cast<unsigned char>(v));
    return rgb;
}

/// Mean difference of all frames, in 8-bit steps.
double write_and_read(std::filesystem::path const& file, double fps)
{
    VideoWriter out(file, kWidth, kHeight, fps);
    for (int k = 0; k < kFrames; ++k) out.add(frame(k));
    EXPECT_FALSE(std::filesystem::exists(file)) << "not before it is complete";
    out.finish();

    cv::VideoCapture in(file.string(), cv::CAP_FFMPEG);
    EXPECT_NEAR(in.get(cv::CAP_PROP_FPS), fps, 2e-3);
    double sum = 0;
    int frames = 0;
    for (cv::Mat image; in.read(image); ++frames) {
        EXPECT_EQ(image.size(), cv::Size(kWidth, kHeight));
        std::vector<unsigned char> const wanted = frame(frames);
        for (int i = 0; i < kWidth * kHeight; ++i)
            for (int c = 0; c < 3; ++c)
                sum += std::abs(int(image.data[3 * i + c]) - int(wanted[std::size_t(3 * i + 2 - c)]));
    }
    EXPECT_EQ(frames, kFrames);
    return sum / (3.0 * kWidth * kHeight * kFrames);
}

TEST(VideoWriter, Ffv1KeepsEveryBit)
{
    TemporaryFolder const folder;
    EXPECT_EQ(write_and_read(folder / "a.mkv", 30), 0);
    EXPECT_EQ(write_and_read(folder / "b:c 100%d.mkv", 30000 / 1001.0), 0);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.mkv", "b:c 100%d.mkv"}));
}

TEST(VideoWriter, H264LooksTheSame)
{
    TemporaryFolder const folder;
    EXPECT_LT(write_and_read(folder / "a.mp4", 24), 6);
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.mp4"});
}

TEST(VideoWriter, LeavesNothingUnfinished)
{
    TemporaryFolder const folder;
    {
        VideoWriter out(folder / "a.mkv", kWidth, kHeight, 30);
        out.add(frame(0));
    }
    EXPECT_TRUE(folder.files().empty()) << testing::PrintToString(folder.files());
}

TEST(VideoWriter, NoticesAFullDisk)
{
    TemporaryFolder const folder;
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    auto const handler = signal(SIGXFSZ, SIG_IGN); // so that writing fails, as on a full disk
    rlimit const small{4000, before.rlim_max};
    for (char const* const name : {"a.mkv", "a.mp4"}) {
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
        {
            VideoWriter out(folder / name, kWidth, kHeight, 30);
            ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
            EXPECT_THROW(
                {
                    for (int k = 0; k < 300; ++k) out.add(frame(k));
                    out.finish();
                },
                gi::InputError)
                << name;
        }
        EXPECT_TRUE(folder.files().empty()) << testing::PrintToString(folder.files());
    }
    signal(SIGXFSZ, handler);
}

TEST(VideoWriter, SaysThatThereIsNoFfmpeg)
{
    TemporaryFolder const folder;
    setenv("IMAGEIO_FFMPEG_EXE", "/nowhere/ffmpeg", 1);
    EXPECT_THROW(VideoWriter(folder / "a.mkv", kWidth, kHeight, 30), gi::InputError);
    setenv("IMAGEIO_FFMPEG_EXE", "false", 1); // one that encodes nothing
    EXPECT_THROW(VideoWriter(folder / "a.mkv", kWidth, kHeight, 30), gi::InputError);
    unsetenv("IMAGEIO_FFMPEG_EXE");
    EXPECT_TRUE(folder.files().empty()) << testing::PrintToString(folder.files());
}

TEST(VideoWriter, RefusesWhatNoVideoCanBe)
{
    EXPECT_NO_THROW(check_video("a.mkv", 64, 48, 30));
    EXPECT_THROW(check_video("a.avi", 64, 48, 30), gi::InputError);
    EXPECT_THROW(check_video("mkv", 64, 48, 30), gi::InputError);
    EXPECT_THROW(check_video("a.mkv", 63, 48, 30), gi::InputError);
    EXPECT_THROW(check_video("a.mp4", 64, 47, 30), gi::InputError);
    EXPECT_THROW(check_video("a.mkv", 64, 48, 0.001), gi::InputError);
    EXPECT_THROW(check_video("a.mkv", 64, 48, 2000), gi::InputError);
    EXPECT_THROW(VideoWriter("/nowhere/a.mkv", 64, 48, 30), gi::InputError);
}

} // namespace
} // namespace viewer::test
