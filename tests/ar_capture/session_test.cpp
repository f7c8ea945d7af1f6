#include "ar/capture/counter_source.h"
#include "ar/capture/session_reader.h"
#include "ar/capture/session_writer.h"
#include "gi/core/error.h"
#include "tests/ar_capture/temporary_folder.h"

#include <csignal>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <sys/wait.h>
#include <thread>

namespace ar::test {
namespace {

using namespace std::chrono_literals;
using Kind = SourceState::Kind;

constexpr std::array kFormats{PixelFormat::rgb8, PixelFormat::bgr8,  PixelFormat::gray8, PixelFormat::nv12,
                              PixelFormat::yuyv, PixelFormat::mjpeg, PixelFormat::rgb16, PixelFormat::rgb_linear};

/// With gaps between its rows, as cameras have them.
Frame make_frame(PixelFormat format, std::uint64_t sequence, glm::ivec2 size = {8, 6})
{
    Frame f;
    f.sequence = sequence;
    f.captured_s = 1000.1 + 0.1 * double(sequence);
    f.arrived_s = f.captured_s + 1.0 / 3;
    f.origin = TimestampOrigin(sequence % 4);
    f.exposure = {0.01 + 1e-17, 1.1, 1.7, 1.0 / 7};
    f.format = format;
    f.size_px = size;
    int const seed = int(sequence);
    auto const plane = [&](int rows, int cols, int type) {
        return noise(rows, cols + 3, type, seed).colRange(0, cols);
    };
    switch (format) {
    case PixelFormat::rgb8:
    case PixelFormat::bgr8:
        f.planes[0] = plane(size.y, size.x, CV_8UC3);
        break;
    case PixelFormat::gray8:
        f.planes[0] = plane(size.y, size.x, CV_8UC1);
        break;
    case PixelFormat::nv12:
        f.planes = {plane(size.y, size.x, CV_8UC1), plane(size.y / 2, size.x / 2, CV_8UC2)};
        break;
    case PixelFormat::yuyv:
        f.planes[0] = plane(size.y, size.x, CV_8UC2);
        break;
    case PixelFormat::mjpeg: {
        std::vector<uchar> bytes;
        cv::imencode(".jpg", noise(size.y, size.x, CV_8UC3, seed), bytes);
        f.planes[0] = cv::Mat(bytes, true).reshape(1, 1);
        break;
    }
    case PixelFormat::rgb16:
        f.planes[0] = plane(size.y, size.x, CV_16UC3);
        break;
    case PixelFormat::rgb_linear:
        f.planes[0] = plane(size.y, size.x, CV_32FC3);
        break;
    }
    return f;
}

void expect_same(Frame const& a, Frame const& b)
{
    EXPECT_EQ(a.sequence, b.sequence);
    EXPECT_EQ(a.captured_s, b.captured_s);
    EXPECT_EQ(a.arrived_s, b.arrived_s);
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.exposure, b.exposure);
    EXPECT_EQ(a.format, b.format);
    EXPECT_EQ(a.size_px, b.size_px);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(equal(a.planes[i], b.planes[i])) << i;
}

SessionHeader header_of(glm::ivec2 size = {8, 6})
{
    SessionHeader h;
    h.camera = {.name = "a \"camera\"", .id = "id", .size_px = size, .frames_per_s = 30, .controls = {"gain"}};
    h.calibration = "kamera.yaml";
    return h;
}

/// Three frames, sequences 0 to 2.
void record(std::string const& folder)
{
    SessionWriter writer(folder, header_of());
    for (std::uint64_t i = 0; i < 3; ++i) ASSERT_TRUE(writer.append(make_frame(PixelFormat::gray8, i)));
}

TEST(Session, EveryFormatComesBackBitForBit)
{
    TemporaryFolder folder;
    for (PixelFormat const format : kFormats) {
        std::string const name = folder / name_of(format);
        {
            SessionWriter writer(name, header_of());
            for (std::uint64_t i : {0, 1, 2, 5, 6}) ASSERT_TRUE(writer.append(make_frame(format, i)));
            writer.append(Controls{.exposure_time_s = 0.02, .automatic_white_balance = true});
            ASSERT_TRUE(writer.append(make_frame(format, std::uint64_t(-1) - 1)));
            writer.finish();
            EXPECT_EQ(writer.written(), 6u);
            EXPECT_EQ(writer.lost(), 0u);
            EXPECT_EQ(writer.failure(), "");
        }
        SessionReader reader(name);
        EXPECT_EQ(reader.header().calibration, "kamera.yaml");
        EXPECT_EQ(reader.header().camera.name, "a \"camera\"");
        EXPECT_EQ(reader.header().finished->frames, 6u);
        for (std::uint64_t i : {0, 1, 2, 5, 6}) {
            auto const f = reader.next();
            ASSERT_TRUE(f);
            expect_same(*f, make_frame(format, i));
            EXPECT_EQ(reader.controls(), Controls{});
        }
        EXPECT_EQ(reader.counts().dropped, 2u); // 3 and 4
        ASSERT_TRUE(reader.next());
        EXPECT_EQ(reader.controls(), (Controls{.exposure_time_s = 0.02, .automatic_white_balance = true}));
        EXPECT_FALSE(reader.next());
        EXPECT_EQ(reader.end().kind, Kind::ended);
        EXPECT_EQ(reader.counts().refused, 0u);
    }
}

TEST(Session, NothingIsOverwritten)
{
    TemporaryFolder folder;
    record(folder / "s");
    EXPECT_THROW(SessionWriter(folder / "s", header_of()), gi::InputError);
    EXPECT_THROW(SessionWriter(folder / "missing/s", header_of()), gi::InputError);
    SessionReader reader(folder / "s");
    EXPECT_TRUE(reader.next());
}

TEST(Session, WhatDoesNotFitIsCountedAndTheRestIsWhole)
{
    TemporaryFolder folder;
    glm::ivec2 const size{640, 480};
    std::uint64_t appended = 0;
    SessionWriter writer(folder / "s", header_of(size), 2 * 640 * 480);
    Frame const f = make_frame(PixelFormat::gray8, 0, size);
    for (std::uint64_t i = 0; i < 80; ++i) { // as fast as it can: the disk cannot follow
        Frame next = f;
        next.sequence = i;
        appended += writer.append(next);
    }
    Frame const large = make_frame(PixelFormat::rgb8, 80, {1280, 960});
    EXPECT_FALSE(writer.append(large)); // more than may ever wait
    writer.finish();
    EXPECT_FALSE(writer.append(f)); // it is closed
    EXPECT_EQ(writer.written(), appended);
    EXPECT_EQ(writer.written() + writer.lost(), 82u);
    SessionReader reader(folder / "s");
    EXPECT_EQ(reader.header().finished->lost, 81 - appended);
    std::uint64_t read = 0;
    while (reader.next()) ++read;
    EXPECT_EQ(read, appended);
    EXPECT_EQ(reader.end().kind, Kind::ended);
}

TEST(Session, PlanesThatAreNotWhatTheFrameSaysAreRefused)
{
    TemporaryFolder folder;
    SessionWriter writer(folder / "s", header_of());
    Frame f = make_frame(PixelFormat::nv12, 0);
    f.planes[1] = cv::Mat();
    EXPECT_THROW(writer.append(f), gi::InputError);
    f = make_frame(PixelFormat::rgb8, 0);
    f.size_px = {9, 6};
    EXPECT_THROW(writer.append(f), gi::InputError);
    f = make_frame(PixelFormat::rgb8, 0);
    f.captured_s = std::nan("");
    EXPECT_THROW(writer.append(f), gi::InputError);
}

TEST(Session, OfAKilledProcessIsWholeUpToItsLastFrame)
{
    TemporaryFolder folder;
    pid_t const child = fork();
    if (child == 0) {
        try {
            SessionWriter writer(folder / "s", header_of({64, 48}));
            for (std::uint64_t i = 0;; ++i) {
                writer.append(make_frame(PixelFormat::nv12, i, {64, 48}));
                std::this_thread::sleep_for(1ms);
            }
        } catch (...) {
            _exit(1);
        }
    }
    while (file_text(folder / "s/index.jsonl").size() < 5000) {
        ASSERT_EQ(waitpid(child, nullptr, WNOHANG), 0) << "the child has ended";
        std::this_thread::sleep_for(5ms);
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    SessionReader reader(folder / "s");
    std::uint64_t read = 0;
    while (auto const f = reader.next()) expect_same(*f, make_frame(PixelFormat::nv12, read++, {64, 48}));
    EXPECT_GT(read, 10u);
    EXPECT_EQ(reader.counts().refused, 0u);
    EXPECT_EQ(reader.end().kind, Kind::lost);
    EXPECT_NE(reader.end().reason.find("cut off"), std::string::npos);
}

TEST(Session, TruncatedAtAnyByteItEndsWell)
{
    TemporaryFolder folder;
    record(folder / "s");
    for (char const* file : {"index.jsonl", "frames.bin"}) {
        std::string const whole = file_text(folder / (std::string("s/") + file));
        for (std::size_t n = 0; n < whole.size(); ++n) {
            write_file(folder / (std::string("s/") + file), whole.substr(0, n));
            SessionReader reader(folder / "s");
            std::uint64_t read = 0;
            while (auto const f = reader.next()) expect_same(*f, make_frame(PixelFormat::gray8, read++));
            bool const is_index = file == std::string("index.jsonl");
            if (is_index) {
                ASSERT_EQ(reader.end().kind, Kind::lost) << n;
                ASSERT_EQ(reader.counts().refused, 0u) << n;
            } else {
                ASSERT_EQ(read, n / 48) << n;
                ASSERT_EQ(read + reader.counts().refused, 3u) << n;
            }
        }
        write_file(folder / (std::string("s/") + file), whole);
    }
    std::string const whole = file_text(folder / "s/session.json");
    for (std::size_t n = 0; n + 2 < whole.size(); ++n) {
        write_file(folder / "s/session.json", whole.substr(0, n));
        EXPECT_THROW(SessionReader(folder / "s"), gi::InputError) << n;
    }
}

TEST(Session, EveryChangedByteIsSeen)
{
    TemporaryFolder folder;
    record(folder / "s");
    for (char const* file : {"index.jsonl", "frames.bin"}) {
        std::string const path = folder / (std::string("s/") + file);
        std::string const whole = file_text(path);
        for (std::size_t n = 0; n < whole.size(); ++n) {
            std::string changed = whole;
            changed[n] = char(changed[n] ^ 0x11);
            write_file(path, changed);
            SessionReader reader(folder / "s");
            std::uint64_t read = 0;
            while (auto const f = reader.next()) {
                expect_same(*f, make_frame(PixelFormat::gray8, f->sequence));
                ++read;
            }
            ASSERT_LE(read, 2u) << file << n;
            ASSERT_TRUE(reader.counts().refused > 0 || reader.end().kind == Kind::lost) << file << n;
        }
        write_file(path, whole);
    }
}

TEST(Session, ErrorsNameTheirPlace)
{
    TemporaryFolder folder;
    auto const message = [&] {
        try {
            SessionSource source(folder / "s");
        } catch (gi::InputError const& e) {
            return std::string(e.what());
        }
        return std::string("none");
    };
    EXPECT_NE(message().find("is no recorded session"), std::string::npos);
    record(folder / "s");
    std::string const whole = file_text(folder / "s/session.json");
    write_file(folder / "s/session.json", "{\n  \"what\": \"recorded frames\",\n  oops}");
    EXPECT_NE(message().find("session.json:3:3: no JSON"), std::string::npos) << message();
    write_file(folder / "s/session.json", "{\"what\": \"recorded frames\", \"version\": 2}");
    EXPECT_NE(
        message().find("has format 2 (this version reads 1) use the version of the program that recorded it"),
        std::string::npos)
        << message();
    write_file(folder / "s/session.json", whole);
    write_file(folder / "s/frames.bin", "");
    EXPECT_NE(message().find("has no frame (3 are damaged, the last: frame 2: its bytes are not all there)"),
              std::string::npos)
        << message();
    std::filesystem::remove(folder / "s/index.jsonl");
    EXPECT_NE(message().find("has no frame (the index has 0 of 3 frames)"), std::string::npos) << message();
}

TEST(SessionSource, PlaysWhatAnEarlierVersionRecorded)
{
    SessionSource source(std::filesystem::path(LIGHTWELL_SOURCE_DIR) / "tests/data/old/7d477989/camera",
                         Pace::fastest);
    for (std::uint32_t n = 0; n < 2; ++n) {
        auto const frame = source.next(5s);
        ASSERT_TRUE(frame) << n;
        EXPECT_EQ(read_counter(frame->planes[0]), std::optional(std::uint32_t(frame->sequence)));
    }
    EXPECT_FALSE(source.next(5s));
}

TEST(SessionSource, KeepsThePaceAndTheAgeOfThen)
{
    TemporaryFolder folder;
    {
        SessionWriter writer(folder / "s", header_of());
        for (std::uint64_t i = 0; i < 5; ++i) {
            Frame f = make_frame(PixelFormat::nv12, i);
            f.arrived_s = 5000 + 0.02 * double(i) + (i == 4 ? 1000 : 0);
            f.captured_s = f.arrived_s - 0.007;
            writer.append(f);
        }
    }
    SessionSource source(folder / "s");
    EXPECT_EQ(source.description().name, "a \"camera\" (recorded)");
    auto const first = source.next(0ms);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->origin, TimestampOrigin::file);
    for (int i = 1; i < 4; ++i) {
        auto const f = source.next(10s);
        ASSERT_TRUE(f);
        EXPECT_NEAR(f->captured_s - first->captured_s, 0.02 * i, 1e-9);
        EXPECT_GE(f->arrived_s - f->captured_s, 0.007 - 1e-9);
    }
    EXPECT_FALSE(source.next(1ms)); // in 1,000 s
    EXPECT_EQ(source.state().kind, Kind::running);
    EXPECT_EQ(source.counts(), (SourceCounts{.delivered = 4}));
}

TEST(SessionSource, IsAsFastAsAskedWithTheTimesOfThen)
{
    TemporaryFolder folder;
    record(folder / "s");
    SessionSource source(folder / "s", Pace::fastest);
    for (std::uint64_t i = 0; i < 3; ++i) {
        auto f = source.next(0ms);
        ASSERT_TRUE(f);
        Frame const recorded = make_frame(PixelFormat::gray8, i);
        EXPECT_EQ(f->origin, TimestampOrigin::file);
        f->origin = recorded.origin;
        expect_same(*f, recorded);
    }
    EXPECT_FALSE(source.next(1000s)); // at once
    EXPECT_EQ(source.state().kind, Kind::ended);
    EXPECT_EQ(source.set({.gain = 2.0}).size(), 1u);
}

TEST(SessionSource, FramesOutliveIt)
{
    TemporaryFolder folder;
    record(folder / "s");
    std::optional<Frame> f;
    {
        SessionSource source(folder / "s", Pace::fastest);
        f = source.next(0ms);
    }
    EXPECT_TRUE(equal(f->planes[0], make_frame(PixelFormat::gray8, 0).planes[0]));
}

} // namespace
} // namespace ar::test
