#include "ar/capture/clock.h"
#include "ar/capture/counter_source.h"
#include "gi/core/error.h"
#include "tests/ar_capture/temporary_folder.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

namespace ar::test {
namespace {

using namespace std::chrono_literals;

TEST(Counter, ComesBack)
{
    for (std::uint32_t n : {0u, 1u, 2u, 255u, 65536u, 0x12345678u, 0xffffffffu}) {
        cv::Mat picture = noise(480, 640, CV_8UC3, 1);
        draw_counter(picture, n);
        EXPECT_EQ(read_counter(picture), n);
    }
}

TEST(Counter, SurvivesJpegScalingNoiseAndGrey)
{
    cv::RNG rng(3);
    for (int i = 0; i < 50; ++i) {
        std::uint32_t const n = rng.next();
        cv::Mat picture = noise(480, 640, CV_8UC3, i);
        draw_counter(picture, n);
        std::vector<uchar> bytes;
        cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 30});
        EXPECT_EQ(read_counter(cv::imdecode(bytes, cv::IMREAD_COLOR)), n);
        cv::Mat gray, small, large, noisy;
        cv::cvtColor(picture, gray, cv::COLOR_RGB2GRAY);
        EXPECT_EQ(read_counter(gray), n);
        cv::resize(picture, small, {320, 240}, 0, 0, cv::INTER_AREA);
        EXPECT_EQ(read_counter(small), n);
        cv::resize(picture, large, {1000, 700}, 0, 0, cv::INTER_LINEAR);
        EXPECT_EQ(read_counter(large), n);
        picture.convertTo(noisy, CV_8U, 0.6, 30);
        cv::Mat const grain = noise(480, 640, CV_8UC3, 100 + i) / 4;
        EXPECT_EQ(read_counter(noisy + grain), n);
    }
}

TEST(Counter, IsNotReadWhereThereIsNone)
{
    int read = 0;
    for (int i = 0; i < 400; ++i) { // only the CRC can reject these random cells
        cv::Mat picture(200, 520, CV_8UC1, cv::Scalar(0));
        cv::RNG rng(std::uint64_t(i) + 1);
        for (int c = 0; c < 52; ++c) picture.colRange(10 * c, 10 * c + 10).setTo(rng.uniform(0, 2) * 255);
        picture.colRange(0, 10).setTo(255);
        picture.colRange(10, 20).setTo(0);
        picture.colRange(500, 510).setTo(0);
        picture.colRange(510, 520).setTo(255);
        read += read_counter(picture).has_value();
    }
    EXPECT_LE(read, 1); // 400 / 65536 expected
    EXPECT_FALSE(read_counter(cv::Mat()));
    EXPECT_FALSE(read_counter(cv::Mat(10, 10, CV_8UC3)));
    EXPECT_FALSE(read_counter(cv::Mat(480, 640, CV_32FC3, cv::Scalar::all(1))));
    EXPECT_FALSE(read_counter(cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(128))));
}

TEST(Counter, EveryWrongBitIsSeen)
{
    cv::Mat picture(100, 520, CV_8UC1, cv::Scalar(0));
    draw_counter(picture, 0xdeadbeef);
    for (int bit = 2; bit < 50; ++bit) {
        cv::Mat changed = picture.clone();
        cv::bitwise_not(picture.colRange(10 * bit, 10 * bit + 10), changed.colRange(10 * bit, 10 * bit + 10));
        EXPECT_FALSE(read_counter(changed)) << bit;
    }
}

TEST(CounterSource, CountsAsFastAsAsked)
{
    for (PixelFormat const format : {PixelFormat::rgb8, PixelFormat::gray8, PixelFormat::mjpeg}) {
        CounterSource source({.format = format, .frames = 20, .pace = Pace::fastest});
        double last_s = 0;
        for (std::uint64_t i = 0; i < 20; ++i) {
            auto const f = source.next(0ms);
            ASSERT_TRUE(f);
            EXPECT_EQ(f->sequence, i);
            EXPECT_EQ(read_counter(rgb_of(*f)), i);
            EXPECT_GE(f->captured_s, last_s);
            EXPECT_LE(f->captured_s, f->arrived_s);
            last_s = f->captured_s;
        }
        EXPECT_FALSE(source.next(0ms));
        EXPECT_EQ(source.state().kind, SourceState::Kind::ended);
        EXPECT_EQ(source.counts(), (SourceCounts{.delivered = 20}));
    }
}

TEST(CounterSource, FramesAreCapturedWhenTheyAreDue)
{
    CounterSource source({.frames_per_s = 100, .frames = 10});
    std::optional<Frame> first;
    while (source.state().kind == SourceState::Kind::running) {
        auto const f = source.next(1000ms);
        ASSERT_TRUE(f);
        if (!first) first = f;
        EXPECT_NEAR(f->captured_s - first->captured_s, double(f->sequence - first->sequence) / 100, 1e-9);
        EXPECT_GE(f->arrived_s, f->captured_s);
        EXPECT_EQ(f->origin, TimestampOrigin::sensor);
    }
    auto const counts = source.counts();
    EXPECT_EQ(counts.delivered + counts.dropped + first->sequence, 10u);
}

TEST(CounterSource, WhatWasNotAskedForInTimeIsDropped)
{
    CounterSource source({.frames_per_s = 100});
    auto const first = source.next(1000ms);
    ASSERT_TRUE(first);
    std::this_thread::sleep_for(200ms);
    auto const second = source.next(1000ms);
    ASSERT_TRUE(second);
    EXPECT_GE(second->sequence, first->sequence + 20);
    EXPECT_EQ(source.counts().dropped, second->sequence - first->sequence - 1);
    EXPECT_EQ(read_counter(second->planes[0]), second->sequence);
}

TEST(CounterSource, DoesNotWaitLongerThanAllowed)
{
    CounterSource source({.frames_per_s = 0.1});
    ASSERT_TRUE(source.next(0ms));
    EXPECT_FALSE(source.next(1ms)); // the next one is due in 10 s
    EXPECT_EQ(source.state().kind, SourceState::Kind::running);
}

TEST(CounterSource, RefusesWhatCannotBe)
{
    EXPECT_THROW(CounterSource({.size_px = {100, 100}}), gi::InputError);
    EXPECT_THROW(CounterSource({.frames_per_s = 0}), gi::InputError);
    EXPECT_THROW(CounterSource({.format = PixelFormat::nv12}), gi::InputError);
    CounterSource source;
    EXPECT_EQ(source.set({.gain = 2, .frame_duration_s = 0.1}).size(), 2u);
    EXPECT_TRUE(source.set({}).empty());
    EXPECT_THROW(source.set({.gain = -1}), gi::InputError);
    EXPECT_THROW(source.set({.automatic_exposure = true, .exposure_time_s = 0.01}), gi::InputError);
    EXPECT_THROW(source.set({.red_gain = 1}), gi::InputError);
}

TEST(DriverClock, IsFoundByWhatIsNotInTheFuture)
{
    DriverClocks const awake{1000, 1000.0000005}, slept{1000, 5000};
    EXPECT_NEAR(steady_time_of(999'950'000'000, awake).value(), 999.95, 1e-9);
    EXPECT_NEAR(steady_time_of(999'950'000'000, slept).value(), 999.95, 1e-9);
    EXPECT_NEAR(steady_time_of(4'999'950'000'000, slept).value(), 999.95, 1e-9); // boot time
    EXPECT_FALSE(steady_time_of(0, awake));
    EXPECT_FALSE(steady_time_of(-1, awake));
    EXPECT_FALSE(steady_time_of(2'000'000'000'000, awake)); // ahead of both
    EXPECT_FALSE(steady_time_of(900'000'000'000, slept));   // too old for either
    DriverClocks const now = driver_clocks();
    EXPECT_NEAR(now.monotonic_s, steady_now_s(), 1);
    EXPECT_GE(now.boottime_s, now.monotonic_s - 0.001);
}

} // namespace
} // namespace ar::test
