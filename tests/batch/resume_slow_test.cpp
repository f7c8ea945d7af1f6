// Renders of a batch whose machine is switched off again and again.

#include "tests/batch/fake_programs.h"
#include "viewer/batch/store.h"

#include <random>
#include <sys/prctl.h>
#include <sys/wait.h>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

constexpr char const* kPictures =
    "batch: m\nsweeps:\n  s:\n    command: render cornell --size 64x64 --paths 3000 --threads 1 --seed {n} "
    "--quiet "
    "--checkpoint 200ms --out a-{n}.exr\n    over: {n: [1, 2]}\n    outputs: \"a-{n}.exr\"\n";

/// Of two tasks at a time with states every 0.2 s each kill of all processes costs what was done since the last
/// state, and the pictures are those of uninterrupted renders.
TEST(BatchResumeSlow, MachineSwitchedOffCostsAnIntervalOfEachPicture)
{
    if (std::system("unshare --pid --fork --kill-child true 2>/dev/null") != 0)
        GTEST_SKIP() << "unshare is not permitted";
    TemporaryFolder const folder;
    std::ofstream(folder / "m.yaml") << kPictures;
    run_well("batch m.yaml --quiet --store undisturbed --cores 2", folder.path(), std::chrono::seconds(900));
    run_well("batch gather undisturbed --out expected", folder.path());

    std::string const command = fmt::format(
        "exec unshare --pid --fork --kill-child --mount-proc {} batch m.yaml --quiet --cores 2", LIGHTWELL_BATCH);
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    std::mt19937 random(3);
    auto const states = [&] {
        std::map<std::string, fs::file_time_type> found;
        std::error_code none;
        for (auto const& entry : fs::recursive_directory_iterator(folder / "m.batch/work", none))
            if (entry.path().extension() == ".state")
                found[entry.path().filename()] = fs::last_write_time(entry.path());
        return found;
    };
    auto const results = [&] {
        if (!fs::exists(folder / "m.batch/format")) return 0;
        batch::Store const store = batch::Store::open(folder / "m.batch");
        if (store.batches().empty()) return 0;
        auto const tasks = store.batch(store.batches().front()).tasks;
        return int(std::ranges::count_if(tasks, [&](batch::Task const& t) { return bool(store.result(t.key)); }));
    };
    int kills = 0, lost = 0;
    double longest_s = 0;
    std::map<std::string, fs::file_time_type> before;
    while (results() < 2 && kills < 200) {
        auto const begun = fs::file_time_type::clock::now();
        pid_t const child = fork();
        if (child == 0) {
            if (chdir(folder.path().c_str()) != 0) _exit(1);
            execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            _exit(1);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2500 + random() % 2000));
        kill(child, SIGKILL);
        auto const killed = fs::file_time_type::clock::now();
        while (waitpid(-1, nullptr, 0) > 0) {
        }
        ++kills;
        auto const now = states();
        for (auto const& [name, written] : before) lost += !now.contains(name) && results() < 1;
        for (auto const& [name, written] : now)
            longest_s =
                std::max(longest_s, std::chrono::duration<double>(killed - std::max(written, begun)).count());
        before = now;
    }
    EXPECT_GE(kills, 3) << "it was complete too soon";
    EXPECT_LT(kills, 200) << "it makes no progress";
    EXPECT_EQ(lost, 0) << "states that the next run did not go on from";
    // An interval, or 50 times what a write takes (30 ms where the disk is busy), and the pass that ends after it.
    // Runs are longer.
    EXPECT_LE(longest_s, std::max(0.2, 50 * 0.03) + 0.6);
    run_well("batch m.yaml --quiet --cores 2", folder.path(), std::chrono::seconds(900));
    run_well("batch gather m.batch --out gathered", folder.path());
    for (char const* const name : {"s/a-1.exr", "s/a-2.exr"})
        EXPECT_TRUE(file_text(folder / "gathered" / name) == file_text(folder / "expected" / name)) << name;
    std::printf("%d times switched off; the oldest last state %.2f s\n", kills, longest_s);
}

} // namespace
} // namespace viewer::test
