// Without mpirun a cluster of one does nothing.

#include "gi/core/error.h"
#include "viewer/protocol/cluster/cluster.h"
#include "viewer/protocol/cluster/process_watch.h"
#include "viewer/protocol/cluster/wire.h"
#include "viewer/protocol/frame_command.h"

#include <csignal>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace viewer::test {
namespace {

TEST(Cluster, AloneNothingWaits)
{
    ASSERT_FALSE(Cluster::started_by_mpirun());
    Cluster cluster({"test", "scene", 1});
    EXPECT_TRUE(cluster.alone());
    EXPECT_TRUE(cluster.leads());
    EXPECT_TRUE(cluster.name().starts_with("rank 0 on "));
    for (std::uint64_t frame = 0; frame < 3; ++frame) {
        FrameCommand command;
        command.frame = frame;
        cluster.send(to_bytes(command));
        KeepAlive const alive(cluster);
        cluster.wait(frame);
        cluster.report_swap(frame, Cluster::now_s());
    }
    EXPECT_FALSE(cluster.receive());
    EXPECT_EQ(cluster.swap_skew().frames, 0u);
    cluster.finish();
}

TEST(Cluster, SettingsAreChecked)
{
    EXPECT_EQ(parse_on_rank_loss("stop"), OnRankLoss::stop);
    EXPECT_EQ(parse_on_rank_loss("continue"), OnRankLoss::go_on);
    EXPECT_THROW(parse_on_rank_loss("panic"), gi::InputError);
    EXPECT_THROW(Cluster({}, {OnRankLoss::stop, 0, 60}), gi::InputError);
}

TEST(Wire, ComesBackAndRefusesWhatIsCutShort)
{
    Writer out(MessageKind::lost);
    out.put(std::int32_t(7)).put(std::string("rank 7")).put(0.1);
    std::vector<std::uint8_t> const bytes = out.take();
    Reader in(bytes);
    EXPECT_EQ(in.get<MessageKind>(), MessageKind::lost);
    EXPECT_EQ(in.get<std::int32_t>(), 7);
    EXPECT_EQ(in.text(), "rank 7");
    EXPECT_EQ(in.get<double>(), 0.1);
    EXPECT_TRUE(in.rest().empty());
    for (std::size_t n = 0; n < bytes.size(); ++n) {
        Reader part({bytes.data(), n});
        EXPECT_THROW(
            {
                part.get<MessageKind>();
                part.get<std::int32_t>();
                part.text();
                part.get<double>();
            },
            std::runtime_error);
    }
}

TEST(ProcessWatch, KnowsWhetherAProcessRuns)
{
    ProcessId const here = this_process();
    EXPECT_EQ(state_of(here, here), ProcessState::runs);
    ProcessId elsewhere = here;
    elsewhere.machine += "another";
    EXPECT_EQ(state_of(elsewhere, here), ProcessState::unknown);
    ProcessId earlier = here; // whose number was given again
    earlier.started -= 1;
    EXPECT_EQ(state_of(earlier, here), ProcessState::ended);

    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    pid_t const child = fork();
    if (child == 0) {
        ProcessId const me = this_process();
        if (write(ends[1], &me.started, sizeof me.started) < 0) _exit(1);
        while (true) pause();
    }
    ProcessId other = here;
    other.number = child;
    ASSERT_EQ(read(ends[0], &other.started, sizeof other.started), ssize_t(sizeof other.started));
    EXPECT_EQ(state_of(other, here), ProcessState::runs);
    kill(child, SIGSTOP);
    waitpid(child, nullptr, WUNTRACED);
    EXPECT_EQ(state_of(other, here), ProcessState::stopped);
    kill(child, SIGKILL);
    siginfo_t ignored;
    waitid(P_PID, id_t(child), &ignored, WEXITED | WNOWAIT); // still a zombie
    EXPECT_EQ(state_of(other, here), ProcessState::ended);
    waitpid(child, nullptr, 0);
    EXPECT_EQ(state_of(other, here), ProcessState::ended);
}

TEST(ProcessWatch, ReadsAProcessThatEndsMeanwhile)
{
    ProcessId const here = this_process();
    for (int i = 0; i < 1000; ++i) {
        pid_t const child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) _exit(0);
        std::jthread const collects([child] { waitpid(child, nullptr, 0); });
        ProcessId other = here;
        other.number = child;
        while (kill(child, 0) == 0) ASSERT_NO_THROW(state_of(other, here));
    }
}

} // namespace
} // namespace viewer::test
