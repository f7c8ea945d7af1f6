// kill -9 at random moments of tasks, workers, runners, servers, and of everything at once.

#include "tests/batch/fake_programs.h"
#include "tests/batch/processes.h"
#include "viewer/batch/work.h"

#include <random>
#include <sys/prctl.h>
#include <sys/wait.h>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr int kKills = 50;
constexpr char const* kRetries = "    retries: 50\n"; // one task may be hit often

struct KillTest : testing::Test {
    /// Runs a batch of 240 tasks and kills `what` until it was killed kKills times; after a kill that ends the
    /// runner the batch is resumed.
    void kill_often(std::string const& options, std::vector<std::string> const& what, int allowed_per_kill,
                    Workers which = Workers::none)
    {
        std::mt19937 random(1);
        p.sweep(tasks_, 0.1, "", kRetries);
        std::optional<Program> program;
        program.emplace(words("batch m.yaml --quiet --json " + options), p.folder());
        int kills = 0, worst = 0;
        auto const all_starts = [&] {
            std::string const text = file_text(p / "starts");
            return std::count(text.begin(), text.end(), '\n');
        };
        auto starts_before = all_starts();
        std::optional<Outcome> last;
        while (!last) {
            std::this_thread::sleep_for(std::chrono::milliseconds(random() % 300));
            if (kills < kKills && all_starts() > starts_before && int(p.starts().size()) < tasks_ - 8) {
                starts_before = all_starts(); // the next kill comes when something runs again
                std::vector<int> victims = processes_with(p.folder(), what, which);
                if (victims.empty()) continue;
                kill(victims[random() % victims.size()], SIGKILL);
                ++kills;
            }
            std::this_thread::sleep_for(50ms);
            if (!program->runs()) {
                Outcome const o = program->wait();
                if (o.code == 0 && kills >= kKills) {
                    last = o;
                } else if (o.code == 0) { // done before all kills: more tasks
                    p.sweep(tasks_ += 120, 0.1, "", kRetries);
                    program.emplace(words("batch m.yaml --quiet --json " + options), p.folder());
                } else {
                    EXPECT_EQ(o.signal, SIGKILL) << o.err;
                    program.emplace(words("batch m.yaml --quiet --json " + options), p.folder());
                }
            }
        }
        int repeated = 0;
        auto const starts = p.starts();
        for (auto const& [task, n] : starts) {
            repeated += n - 1;
            worst = std::max(worst, n - 1);
        }
        EXPECT_EQ(starts.size(), std::size_t(tasks_)) << "none lost";
        EXPECT_LE(repeated, kills * allowed_per_kill);
        EXPECT_EQ(json_of(*last)["done"], tasks_);
        expect_outputs();
        std::printf("%d kills, %d tasks: %d attempts repeated, one task at most %d times\n", kills, tasks_,
                    repeated, worst);
    }

    /// Whatever happened, each output is what an undisturbed task writes, and no file is left.
    void expect_outputs()
    {
        ASSERT_EQ(p.run("batch gather m.batch --out r --replace").code, 0);
        for (int n = 1; n <= tasks_; ++n) {
            std::string text;
            for (int i = n; i <= n + 200; ++i) text += std::to_string(i) + "\n";
            ASSERT_EQ(file_text(p / fmt::format("r/s/out-{}.txt", n)), text) << n;
        }
        EXPECT_TRUE(fs::is_empty(p / "m.batch/work"));
    }

    /// Tasks that were started, but of which the next run finds no result.
    std::set<int> started_without_result() const
    {
        if (!fs::exists(p / "m.batch/format")) return {};
        batch::Store const store = batch::Store::open(p / "m.batch");
        if (store.batches().empty()) return {};
        settle_leftovers(store);
        auto const starts = p.starts();
        std::set<int> found;
        for (batch::Task const& task : store.batch(store.batches().front()).tasks)
            if (int const n = std::stoi(task.parameters.at(0).second);
                starts.contains(n) && !store.result(task.key))
                found.insert(n);
        return found;
    }
    /// @param most  of each task that may be started more than once
    void expect_starts(std::map<int, int> const& most) const
    {
        for (auto const& [task, n] : p.starts())
            EXPECT_LE(n, most.contains(task) ? most.at(task) : 1) << "task " << task;
    }

    FakePrograms const p;
    int tasks_ = 240;
};

TEST_F(KillTest, WorkersOfOne) { kill_often("--cores 1", {}, 1, Workers::only); }
TEST_F(KillTest, WorkersOfTwo) { kill_often("--cores 2", {}, 1, Workers::only); }
TEST_F(KillTest, WorkersOfSix) { kill_often("--cores 6", {}, 1, Workers::only); }
TEST_F(KillTest, TasksThemselves) { kill_often("--cores 2", {"bin/lightwell", "render"}, 1); }
TEST_F(KillTest, ServerOfHyperQueue)
{
    if (!has_hyperqueue()) GTEST_SKIP() << "scripts/setup --tests installs HyperQueue";
    kill_often("--on hyperqueue --hq-workers 1", {"python", "call.json"}, 1);
}
TEST_F(KillTest, WorkersOfHyperQueue)
{
    if (!has_hyperqueue()) GTEST_SKIP() << "scripts/setup --tests installs HyperQueue";
    kill_often("--on hyperqueue --hq-workers 2", {}, 1, Workers::only);
}
TEST_F(KillTest, Runner) { kill_often("--cores 2", {"lightwell-batch", "m.yaml"}, 0); }

/// All processes at once, as when a machine is switched off: in a PID namespace whose first process is killed.
/// What was written stays: the loss of the disk's caches is not tried.
TEST_F(KillTest, Machine)
{
    if (std::system("unshare --pid --fork --kill-child true 2>/dev/null") != 0)
        GTEST_SKIP() << "unshare is not permitted";
    std::mt19937 random(2);
    p.sweep(tasks_ = 400, 0.1); // more than are done before the last kill
    constexpr int kCores = 2;
#if !defined(__SANITIZE_ADDRESS__)
    setenv("LD_PRELOAD", SLOW_DISK, 1);
#endif
    std::string const command =
        fmt::format("exec unshare --pid --fork --kill-child --mount-proc {} batch m.yaml --quiet --cores {}",
                    (p / "bin/lightwell-batch").string(), kCores);
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    std::map<int, int> most_starts; // one more for each time that a task was cut
    int kills = 0;
    for (; kills < kKills; ++kills) {
        pid_t const child = fork();
        if (child == 0) {
            if (chdir(p.folder().c_str()) != 0) _exit(1);
            execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            _exit(1);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(100 + random() % 500));
        kill(child, SIGKILL);
        while (waitpid(-1, nullptr, 0) > 0) {
        } // the first process of the namespace is gone when all others are
        expect_starts(most_starts);
        std::set<int> const lost = started_without_result();
        EXPECT_LE(lost.size(), std::size_t(kCores)) << "at most the tasks that ran";
        for (int const task : lost) most_starts[task] = p.starts().at(task) + 1;
    }
    unsetenv("LD_PRELOAD");
    EXPECT_LT(p.starts().size(), std::size_t(tasks_)) << "the last kills met nothing";
    Outcome const o = p.run("batch m.yaml --quiet --json --cores 2");
    EXPECT_EQ(o.code, 0) << o.err;
    expect_starts(most_starts);
    int repeated = 0;
    for (auto const& [task, n] : p.starts()) repeated += n - 1;
    EXPECT_EQ(json_of(o)["done"], tasks_);
    expect_outputs();
    std::printf("%d times switched off with %d tasks at a time: %d attempts repeated\n", kills, kCores, repeated);
}

} // namespace
} // namespace viewer::test
