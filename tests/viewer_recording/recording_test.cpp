#include "gi/core/crc32.h"
#include "gi/core/error.h"
#include "gi/core/xxhash.h"
#include "tests/viewer/run_program.h"
#include "tests/viewer_recording/walk.h"

#include <sys/resource.h>

namespace viewer::test {
namespace {

std::string why_unreadable(std::string const& bytes)
{
    try {
        reader_of(bytes);
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "";
}

std::string recorded(std::uint64_t frames, bool with_end)
{
    TemporaryFolder const folder;
    gi::Report report;
    {
        Recorder recorder(folder / "walk.lwr", walk_header(), report);
        for (std::uint64_t n = 0; n < frames; ++n) recorder.append(walk_frame(n));
    }
    EXPECT_TRUE(report.losses().empty());
    std::string bytes = text_of(folder / "walk.lwr");
    if (!with_end) bytes.resize(bytes.size() - 17); // 4 + 1 + 8 + 4
    return bytes;
}

std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

TEST(Checksums, AreThePublishedOnes)
{
    EXPECT_EQ(gi::crc32(bytes_of("123456789")), 0xCBF43926u);
    EXPECT_EQ(gi::crc32(bytes_of("6789"), gi::crc32(bytes_of("12345"))), 0xCBF43926u);
    auto const hash = [](std::string_view text) { return gi::xxh64(std::as_bytes(std::span(text))); };
    EXPECT_EQ(hash(""), 0xEF46DB3751D8E999u);
    EXPECT_EQ(hash("a"), 0xD24EC4F1A98C6E5Bu);
    EXPECT_EQ(hash("abc"), 0x44BC2CF5AD770999u);
    EXPECT_EQ(hash("Call me Ishmael. Some years ago--never mind how long precisely-"), 0x02a2e85470d6fd96u);
}

TEST(Recording, ComesBackAsItWas)
{
    RecordingReader reader = reader_of(recorded(50, true));
    EXPECT_EQ(reader.header(), walk_header());
    for (int twice = 0; twice < 2; ++twice) {
        for (std::uint64_t n = 0; n < 50; ++n) {
            auto const frame = reader.next();
            ASSERT_TRUE(frame) << n;
            EXPECT_EQ(*frame, walk_frame(n)) << n;
        }
        EXPECT_FALSE(reader.next());
        EXPECT_FALSE(reader.next());
        EXPECT_EQ(reader.end().state, RecordingState::finished);
        EXPECT_EQ(reader.end().frames, 50u);
        EXPECT_EQ(describe_loss(reader.end()), "");
        reader.rewind();
    }
}

TEST(Recording, HasWhatWasShownBetweenItsFrames)
{
    TemporaryFolder const folder;
    gi::Report report;
    std::vector<ShownFrame> shown;
    {
        Recorder recorder(folder / "walk.lwr", walk_header(), report);
        for (std::uint64_t n = 0; n < 6; ++n) {
            recorder.append(walk_frame(n));
            for (std::uint64_t k = 0; k < n % 3; ++k) {
                ShownFrame s{walk_frame(n).command, 0.25 * double(k), {}};
                s.moment.display_s += double(k);
                if (k == 1) s.pixel_hash = n;
                if (n == 2) s.windows = {{0.5, {0}}, {0, {}}, {1, {0, 0}}};
                recorder.append(s);
                shown.push_back(s);
            }
        }
        recorder.finish();
        EXPECT_EQ(recorder.written_frames(), 6u);
    }
    RecordingReader reader(folder / "walk.lwr");
    std::size_t n = 0, k = 0;
    while (auto const record = reader.next_record()) {
        if (auto const* const frame = std::get_if<RecordedFrame>(&*record))
            EXPECT_EQ(*frame, walk_frame(n++));
        else
            EXPECT_EQ(std::get<ShownFrame>(*record), shown.at(k++));
    }
    EXPECT_EQ(n, 6u);
    EXPECT_EQ(k, shown.size());
    EXPECT_EQ(reader.end().state, RecordingState::finished);
    reader.rewind();
    for (n = 0; auto const frame = reader.next(); ++n) EXPECT_EQ(*frame, walk_frame(n));
    EXPECT_EQ(n, 6u) << "frames alone";
}

TEST(Recording, OfAnEarlierVersionIsRead)
{
    for (std::string const commit : {"7d477989"}) {
        RecordingReader reader(std::filesystem::path(LIGHTWELL_SOURCE_DIR) / "tests/data/old" / commit /
                               "cornell.lwr");
        EXPECT_EQ(reader.header().program, "lightwell 0.1.0 (git " + commit + ")");
        EXPECT_EQ(reader.header().scene, "cornell");
        auto const first = reader.next();
        ASSERT_TRUE(first) << commit;
        EXPECT_EQ(first->command.views.at(0).width, 16);
        while (reader.next()) {
        }
        EXPECT_EQ(describe_loss(reader.end()), "") << commit;
        EXPECT_EQ(reader.end().frames, 31u) << commit;
    }
}

TEST(Recording, OfALaterFormatIsRefusedWithTheWayOut)
{
    std::string bytes = recorded(1, true);
    bytes[8] = 3;
    std::string const why = why_unreadable(bytes);
    EXPECT_NE(
        why.find("its format is 3, this version reads 1 to 2) use the version of the program that recorded it"),
        std::string::npos)
        << why;
}

TEST(Recording, EveryCutKeepsTheFramesBeforeIt)
{
    std::string const whole = recorded(6, true);
    std::vector<std::size_t> bytes_of_frames; // with n frames and no end
    for (std::uint64_t n = 0; n <= 6; ++n) bytes_of_frames.push_back(recorded(n, false).size());
    std::uint64_t frames_seen = 0;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        std::string const cut = whole.substr(0, size);
        if (!why_unreadable(cut).empty()) {
            EXPECT_EQ(frames_seen, 0u);
            continue;
        }
        RecordingReader reader = reader_of(cut);
        std::uint64_t n = 0;
        for (; auto const frame = reader.next(); ++n) ASSERT_EQ(*frame, walk_frame(n));
        EXPECT_GE(n, frames_seen);
        frames_seen = n;
        RecordingEnd const& end = reader.end();
        EXPECT_EQ(end.state, RecordingState::cut) << size;
        EXPECT_EQ(end.frames, n);
        EXPECT_EQ(end.last_frame.has_value(), n > 0);
        EXPECT_FALSE(describe_loss(end).empty());
        EXPECT_EQ(reader.bytes() - end.unread_bytes, bytes_of_frames[n]) << size;
    }
    EXPECT_EQ(frames_seen, 6u);
}

TEST(Recording, NoFlippedBitGoesUnseen)
{
    std::string const whole = recorded(3, true);
    std::size_t const header = recorded(0, false).size();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string bytes = whole;
        bytes[i] = char(bytes[i] ^ (1 << (i % 8)));
        if (i < header) {
            EXPECT_NE(why_unreadable(bytes), "") << i;
            continue;
        }
        RecordingReader reader = reader_of(bytes);
        for (std::uint64_t n = 0; auto const frame = reader.next(); ++n) ASSERT_EQ(*frame, walk_frame(n));
        EXPECT_NE(reader.end().state, RecordingState::finished) << i;
        EXPECT_GT(reader.end().unread_bytes, 0u) << i;
    }
}

TEST(Recording, OtherVersionsAndOtherFilesAreRefused)
{
    std::string bytes = recorded(1, true);
    bytes[8] = 3;
    EXPECT_NE(why_unreadable(bytes).find("its format is 3, this version reads 1 to 2"), std::string::npos);
    EXPECT_NE(why_unreadable("").find("does not begin as one"), std::string::npos);
    EXPECT_NE(why_unreadable("PNG, or so").find("does not begin as one"), std::string::npos);
    EXPECT_THROW(RecordingReader("/nowhere/walk.lwr"), gi::InputError);
    EXPECT_THROW(RecordingReader("/tmp"), gi::InputError);
    EXPECT_THROW(RecordingReader("/dev/zero"), gi::InputError);
}

TEST(Recording, FollowingBytesAreReported)
{
    RecordingReader reader = reader_of(recorded(2, true) + "more");
    while (reader.next()) {
    }
    EXPECT_EQ(reader.end().state, RecordingState::damaged);
    EXPECT_EQ(reader.end().unread_bytes, 4u);
    EXPECT_EQ(reader.end().last_frame, 1u);
}

TEST(Recorder, NeverOverwrites)
{
    TemporaryFolder const folder;
    gi::Report report;
    std::ofstream(folder / "walk.lwr") << "precious";
    EXPECT_THROW(Recorder(folder / "walk.lwr", walk_header(), report), gi::InputError);
    EXPECT_EQ(text_of(folder / "walk.lwr"), "precious");
    EXPECT_THROW(Recorder(folder / "none" / "walk.lwr", walk_header(), report), gi::InputError);
}

TEST(Recorder, RefusesWhatCouldNotBeReplayed)
{
    TemporaryFolder const folder;
    gi::Report report;
    Recorder recorder(folder / "walk.lwr", walk_header(), report);
    recorder.append(walk_frame(3));
    EXPECT_THROW(recorder.append(walk_frame(3)), gi::InputError);
    RecordedFrame bad = walk_frame(4);
    bad.command.paths = 0;
    EXPECT_THROW(recorder.append(bad), gi::InputError);
    recorder.append(walk_frame(4));
    recorder.finish();
    recorder.finish();
    EXPECT_EQ(recorder.written_frames(), 2u);
    RecordingReader reader(folder / "walk.lwr");
    EXPECT_EQ(reader.next(), walk_frame(3));
    EXPECT_EQ(reader.next(), walk_frame(4));
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.end().state, RecordingState::finished);
}

/// Runs in a child process, as the limit of file sizes cannot be raised again. Returns 0 if all went as expected.
int record_onto_a_full_disk(std::filesystem::path const& file)
{
    signal(SIGXFSZ, SIG_IGN);
    rlimit const limit{20000, 20000};
    setrlimit(RLIMIT_FSIZE, &limit);
    gi::Report report;
    Recorder recorder(file, walk_header(), report);
    for (std::uint64_t n = 0; n < 200; ++n) {
        recorder.append(walk_frame(n));
        if (n % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    recorder.finish();
    if (recorder.failure().empty()) return 1;
    auto const losses = report.losses();
    if (losses.size() != 1) return 2;
    if (losses.begin()->second.first.find("too large") == std::string::npos) return 3; // EFBIG
    RecordingReader reader(file);
    while (reader.next()) {
    }
    RecordingEnd const& end = reader.end();
    if (end.state != RecordingState::cut || end.unread_bytes != 0 || end.frames < 40) return 4;
    if (end.frames != recorder.written_frames()) return 6;
    return end.frames + losses.begin()->second.count == 200 ? 0 : 5;
}

TEST(Recorder, FullDiskLosesWhatFollowsAndCountsIt)
{
    TemporaryFolder const folder;
    pid_t const child = fork();
    if (child == 0) _exit(record_onto_a_full_disk(folder / "walk.lwr"));
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
    RecordingReader reader(folder / "walk.lwr");
    EXPECT_EQ(reader.next(), walk_frame(0));
}

} // namespace
} // namespace viewer::test
