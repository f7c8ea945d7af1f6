// Ranks that die, stall or do not fit, with a real mpirun. The rank of every test program writes down what it
// got, said and returned (client/client.cpp).

#include "tests/viewer_cluster/mpirun.h"

#include <csignal>
#include <fmt/format.h>

namespace viewer::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Written by one rank.
struct Log {
    int pid = 0, code = -1; ///< -1: it did not come to its end
    std::string name;
    std::vector<std::string> frames, said, rest;

    std::string all_said() const
    {
        std::string all;
        for (std::string const& s : said) all += s + "\n";
        return all;
    }
};

class Ranks : public testing::Test {
protected:
    static constexpr int kRanks = 4;

    void SetUp() override
    {
        if (!has_mpirun()) GTEST_SKIP() << "no mpirun here: several machines are not tested";
    }
    void TearDown() override
    {
        if (HasFailure()) std::printf("%s\n", file_text(folder_ / "mpirun.out").c_str());
    }
    std::unique_ptr<Mpirun> start(int frames, std::string const& options, std::string const& more = "")
    {
        return std::make_unique<Mpirun>(
            kRanks, more, fmt::format("{} {} {} 5 {}", CLUSTER_CLIENT, folder_.path().string(), frames, options),
            folder_.path());
    }
    Log log(int rank) const
    {
        Log log;
        std::istringstream in(file_text(folder_ / fmt::format("rank.{}", rank)));
        for (std::string line; std::getline(in, line);) {
            auto const blank = line.find(' ');
            std::string const key = line.substr(0, blank), value = line.substr(blank + 1);
            if (in.eof()) break; // not whole yet
            if (key == "pid")
                log.pid = std::stoi(value);
            else if (key == "left")
                log.code = std::stoi(value);
            else if (key == "name")
                log.name = value;
            else if (key == "said")
                log.said.push_back(value);
            else if (std::isdigit(key[0]) != 0)
                log.frames.push_back(line);
            else
                log.rest.push_back(line);
        }
        return log;
    }
    /// Waits until a rank has rendered this number of frames. @return its name
    std::string signal_at(int rank, std::size_t frame, int signal)
    {
        auto const limit = Clock::now() + std::chrono::seconds(60);
        while (log(rank).frames.size() < frame && Clock::now() < limit)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        Log const l = log(rank);
        EXPECT_GE(l.frames.size(), frame);
        if (l.pid > 0) kill(l.pid, signal);
        signalled_ = Clock::now();
        return l.name;
    }
    double since_signal_s() const { return std::chrono::duration<double>(Clock::now() - signalled_).count(); }
    /// Waits until a rank has come to its end by itself.
    Log ended(int rank, double limit_s)
    {
        while (log(rank).code < 0 && since_signal_s() < limit_s)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return log(rank);
    }
    void expect_all_say(std::string const& victim, int lost, std::string const& how, double limit_s)
    {
        for (int r = 0; r < kRanks; ++r) {
            if (r == lost) continue;
            Log const l = ended(r, limit_s);
            EXPECT_EQ(l.code, 1) << "rank " << r << " after " << since_signal_s() << " s: " << l.all_said();
            EXPECT_NE(l.all_said().find(victim + " " + how), std::string::npos) << l.all_said();
        }
    }

    TemporaryFolder folder_;
    Clock::time_point signalled_ = Clock::now();
};

TEST_F(Ranks, GoInLockStep)
{
    auto const mpirun = start(200, "10 stop");
    EXPECT_EQ(mpirun->wait(), 0) << mpirun->text();
    std::vector<std::string> const frames = log(0).frames;
    ASSERT_EQ(frames.size(), 200u);
    for (int r = 0; r < kRanks; ++r) {
        Log const l = log(r);
        EXPECT_EQ(l.code, 0) << l.all_said();
        EXPECT_EQ(l.frames, frames) << "rank " << r << ": other times or orders";
        EXPECT_TRUE(l.name.starts_with(fmt::format("rank {} on ", r))) << l.name;
    }
    bool has_skew = false;
    int clocks = 0;
    std::vector<std::string> notes;
    for (std::string const& line : log(0).rest) {
        if (line.starts_with("note")) notes.push_back(line);
        std::printf("%s\n", line.c_str());
        has_skew |= line.starts_with("skew swap skew of 200 frames");
        if (!line.starts_with("clock")) continue;
        // One machine has one steady clock.
        auto const w = words(line);
        EXPECT_LE(std::abs(std::stod(w[2])), std::stod(w[3]) + 1e-6) << line;
        EXPECT_LT(std::stod(w[3]), 0.05) << line;
        ++clocks;
    }
    EXPECT_TRUE(has_skew);
    EXPECT_EQ(clocks, kRanks - 1);
    EXPECT_EQ(notes, (std::vector<std::string>{"note 10 of rank 1", "note 10 of rank 2", "note 10 of rank 3"}));
}

TEST_F(Ranks, SameOverTcp)
{
    EXPECT_EQ(start(50, "10 stop", "--mca btl self,tcp --mca btl_tcp_if_include lo")->wait(), 0);
    for (int r = 0; r < kRanks; ++r) EXPECT_EQ(log(r).frames.size(), 50u);
}

TEST_F(Ranks, AKilledFollowerStopsAll)
{
    auto const mpirun = start(100000, "5 stop", recovery_option());
    std::string const victim = signal_at(2, 20, SIGKILL);
    expect_all_say(victim, 2, "has died", 5);
    mpirun->wait(std::chrono::seconds(20));
}

TEST_F(Ranks, AKilledFollowerStopsAllOverTcp)
{
    auto const mpirun =
        start(100000, "5 stop", recovery_option() + " --mca btl self,tcp --mca btl_tcp_if_include lo");
    std::string const victim = signal_at(1, 20, SIGKILL);
    expect_all_say(victim, 1, "has died", 5);
    mpirun->wait(std::chrono::seconds(20));
}

TEST_F(Ranks, OthersGoOnWithoutAKilledFollower)
{
    auto const mpirun = start(300, "5 continue", recovery_option());
    std::string const victim = signal_at(2, 20, SIGKILL);
    mpirun->wait(std::chrono::seconds(60));
    std::vector<std::string> const frames = log(0).frames;
    EXPECT_EQ(frames.size(), 300u);
    for (int r : {0, 1, 3}) {
        Log const l = log(r);
        EXPECT_EQ(l.code, 0) << l.all_said();
        EXPECT_EQ(l.frames, frames);
        EXPECT_NE(l.all_said().find(victim + " has died"), std::string::npos) << l.all_said();
    }
    EXPECT_EQ(log(2).code, -1);
}

TEST_F(Ranks, AStalledFollowerStopsAll)
{
    auto const mpirun = start(100000, "2 stop", recovery_option());
    std::string const victim = signal_at(3, 20, SIGSTOP);
    expect_all_say(victim, 3, "has not answered for 2.", 6);
    EXPECT_GT(since_signal_s(), 1.9);
    EXPECT_NE(log(0).all_said().find("its process is stopped"), std::string::npos) << log(0).all_said();
    kill(log(3).pid, SIGCONT); // and finds that it was left behind
    Log const late = ended(3, 10);
    EXPECT_EQ(late.code, 1);
    EXPECT_NE(late.all_said().find("left behind"), std::string::npos) << late.all_said();
    mpirun->wait(std::chrono::seconds(20));
}

TEST_F(Ranks, OthersGoOnWithoutAStalledFollower)
{
    auto const mpirun = start(300, "2 continue", recovery_option());
    std::string const victim = signal_at(1, 20, SIGSTOP);
    for (int r : {0, 2, 3}) {
        Log const l = ended(r, 30);
        EXPECT_EQ(l.code, 0) << l.all_said();
        EXPECT_EQ(l.frames.size(), 300u);
        EXPECT_NE(l.all_said().find(victim + " has not answered"), std::string::npos) << l.all_said();
    }
    kill(log(1).pid, SIGCONT);
    EXPECT_EQ(ended(1, 40).code, 1);
    mpirun->wait(std::chrono::seconds(20));
}

TEST_F(Ranks, FollowersStopWithoutTheirLeader)
{
    auto const mpirun = start(100000, "5 continue", recovery_option()); // without a leader no rank can continue
    std::string const victim = signal_at(0, 20, SIGKILL);
    expect_all_say(victim, 0, "has died", 5);
    EXPECT_NE(log(1).all_said().find("it was the leader"), std::string::npos);
    mpirun->wait(std::chrono::seconds(20));
}

TEST_F(Ranks, FollowersStopWhereTheirLeaderStalls)
{
    auto const mpirun = start(100000, "2 stop", recovery_option());
    std::string const victim = signal_at(0, 20, SIGSTOP);
    expect_all_say(victim, 0, "has not answered for 2.", 6);
    kill(log(0).pid, SIGKILL);
    mpirun->wait(std::chrono::seconds(20));
}

TEST_F(Ranks, WithoutRecoveryMpirunEndsAll)
{
    auto const mpirun = start(100000, "5 continue");
    signal_at(2, 20, SIGKILL);
    EXPECT_NE(mpirun->wait(std::chrono::seconds(20)), 0);
    EXPECT_NE(mpirun->text().find("rank 2"), std::string::npos) << mpirun->text();
    for (int r = 0; r < kRanks; ++r) {
        auto const runs = [&] {
            std::string const stat = file_text(fmt::format("/proc/{}/stat", log(r).pid));
            return !stat.empty() && stat.find(") Z ") == std::string::npos;
        };
        while (runs() && since_signal_s() < 10) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        EXPECT_FALSE(runs()) << "rank " << r;
    }
}

TEST_F(Ranks, AnotherVersionIsRefused)
{
    EXPECT_NE(start(10, "5 stop --other-version 2 0", recovery_option())->wait(), -1);
    for (int r = 0; r < kRanks; ++r) {
        Log const l = log(r);
        EXPECT_EQ(l.code, 2) << r;
        EXPECT_NE(l.all_said().find("rank 2 on "), std::string::npos) << l.all_said();
        EXPECT_NE(l.all_said().find("runs test 2"), std::string::npos) << l.all_said();
        EXPECT_TRUE(l.frames.empty());
    }
}

TEST_F(Ranks, AnotherSceneFileIsRefused)
{
    EXPECT_NE(start(10, "5 stop --other-scene 3 0", recovery_option())->wait(), -1);
    for (int r = 0; r < kRanks; ++r) {
        EXPECT_EQ(log(r).code, 2) << r;
        EXPECT_NE(log(r).all_said().find("the scene file of rank 3 on "), std::string::npos) << log(r).all_said();
    }
}

TEST_F(Ranks, OneThatComputesSomethingElseIsFound)
{
    EXPECT_NE(start(100, "5 stop --astray 1 30", recovery_option())->wait(), -1);
    for (int r = 0; r < kRanks; ++r) {
        EXPECT_EQ(log(r).code, 1) << r;
        EXPECT_EQ(log(r).frames.size(), 31u);
        EXPECT_NE(log(r).all_said().find("has another scene or other commands"), std::string::npos)
            << log(r).all_said();
    }
}

TEST_F(Ranks, WorkIsNoStall)
{
    for (char const* busy : {"3 stop --busy 2 4", "3 stop --busy 0 4"}) {
        auto const mpirun = start(20, busy);
        EXPECT_EQ(mpirun->wait(), 0) << mpirun->text();
        for (int r = 0; r < kRanks; ++r) EXPECT_EQ(log(r).code, 0) << log(r).all_said() << mpirun->text();
    }
}

TEST_F(Ranks, OneThatComesLateIsAwaited)
{
    auto const mpirun = start(20, "3 stop --slow-start 3 5");
    EXPECT_EQ(mpirun->wait(), 0) << mpirun->text();
    for (int r = 0; r < kRanks; ++r) EXPECT_EQ(log(r).code, 0) << log(r).all_said();
}

} // namespace
} // namespace viewer::test
