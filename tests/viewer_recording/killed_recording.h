#pragma once
// Processes that record until they are killed, at random moments.

#include "gi/core/error.h"
#include "tests/viewer/run_program.h"
#include "tests/viewer_recording/walk.h"
#include "viewer/protocol/recording/frame_log.h"

#include <atomic>
#include <random>
#include <sys/mman.h>

namespace viewer::test {

constexpr std::size_t kMostFrames = 4000;

inline double now_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Shared with the child: when each frame was given to the recorder.
struct Appended {
    std::atomic<std::size_t> frames;
    double at_s[kMostFrames];
};

[[noreturn]] inline void record_until_killed(std::filesystem::path const& folder, Appended& appended)
{
    gi::Report report;
    Recorder recorder(folder / "walk.lwr", walk_header(), report);
    FrameLog log(folder / "frames.csv", "", report);
    for (std::size_t n = 0; n < kMostFrames; ++n) {
        recorder.append(walk_frame(n));
        FrameTimes times;
        times.frame = n;
        log.append(times);
        appended.at_s[n] = now_s();
        appended.frames = n + 1;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    pause();
    _exit(0);
}

struct Child {
    TemporaryFolder folder;
    Appended* appended = static_cast<Appended*>(
        mmap(nullptr, sizeof(Appended), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    pid_t id = 0;
    double killed_s = 0;
    ~Child() { munmap(appended, sizeof(Appended)); }
};

inline std::size_t logged_frames(Child const& child)
{
    auto const lines = [](std::string const& text) { return std::size_t(std::count(text.begin(), text.end(), '\n')); };
    std::size_t const all = lines(text_of(child.folder / "frames.csv")), header = lines(frame_times_header());
    return all - std::min(all, header);
}

/// Of a running process: whether both files hold a frame.
inline bool has_kept(Child const& child)
{
    try {
        return logged_frames(child) > 0 && RecordingReader(child.folder / "walk.lwr").next().has_value();
    } catch (gi::InputError const&) { // without a whole header
        return false;
    }
}

/// The recording has the frames from the first one on, each whole. @return age of the oldest that it lacks, s
inline double lost_s(Child const& child)
{
    std::size_t const given = child.appended->frames;
    RecordingReader reader(child.folder / "walk.lwr");
    std::uint64_t n = 0;
    for (; auto const frame = reader.next(); ++n) EXPECT_EQ(*frame, walk_frame(n));
    EXPECT_EQ(reader.end().state, RecordingState::cut) << describe_loss(reader.end());
    std::size_t const kept = std::min(std::size_t(n), logged_frames(child));
    EXPECT_GT(kept, 0u);
    return kept < given ? child.killed_s - child.appended->at_s[kept] : 0;
}

/// Kills four recording processes in each round. @return the most that one of them lost, s
inline double kill_recordings(int rounds)
{
    std::mt19937 random(20);
    double most_s = 0;
    for (int round = 0; round < rounds; ++round) {
        std::array<Child, 4> children;
        for (Child& c : children) {
            c.id = fork();
            if (c.id == 0) record_until_killed(c.folder.path(), *c.appended);
        }
        for (Child const& c : children)
            while (!has_kept(c)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        for (Child& c : children) {
            std::this_thread::sleep_for(std::chrono::microseconds(random() % 500000));
            kill(c.id, SIGKILL);
            c.killed_s = now_s();
            waitpid(c.id, nullptr, 0);
        }
        for (Child const& c : children) most_s = std::max(most_s, lost_s(c));
    }
    return most_s;
}

} // namespace viewer::test
