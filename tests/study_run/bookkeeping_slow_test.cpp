// What a participant waits for between two trials.

#include "gi/core/quantile.h"
#include "tests/study_run/support.h"

#include <fcntl.h>
#include <fmt/format.h>

namespace study::test {
namespace {

/// What the disk alone takes for as many lines: other processes may keep it busy.
double disk_p99_ms(std::filesystem::path const& file)
{
    int const fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    std::string const line(700, 'x');
    std::vector<double> ms;
    for (int i = 0; i < 600; ++i) {
        auto const start = std::chrono::steady_clock::now();
        EXPECT_EQ(write(fd, line.data(), line.size()), ssize_t(line.size()));
        fdatasync(fd);
        ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    close(fd);
    return gi::quantile(std::move(ms), 0.99);
}

TEST(Bookkeeping, OfSixHundredTrialsStaysBelowAMillisecond)
{
    // Two staircases, QUEST+ and repeated bad trials.
    Script const s = parse(R"(
timing: {vsync: record}
factors: {scene: [atrium], quality: {many: {paths: 4096}}}
reference: {quality: many}
sequence: [paths]
blocks:
  paths:
    task: 2ifc
    prompt: "Which?"
    stimulus_ms: 1000
    compare: {vary: paths, scale: log2, range: [1, 1024], harder: up}
    interleave:
      - {name: down2, method: staircase, up: 1, down: 2, start: 16, steps: [2, 1], stop: {max_trials: 200}}
      - {name: weighted, method: staircase, target: 0.8, start: 16, steps: [2, 1], stop: {max_trials: 200}}
      - {name: qp, method: questplus, threshold: 1..1024/33, slope: [1, 2, 3.5, 5], guess: 0.5, lapse: [0, 0.02, 0.04], stop: {trials: 200}}
    cross: [scene]
)");
    TemporaryFolder const dir;
    bool was_quiet = false;
    for (int attempt = 0; attempt < 5; ++attempt) {
        TestPresenter p;
        p.on_show = [](TrialRequest const& r, TrialDone& t) {
            if ((r.step_index * 7919) % 10 > 6) t.response = t.response == "first" ? "second" : "first";
            if (r.step_index % 50 == 3 && r.attempt == 1) t.shown[0].frames_dropped = 2;
        };
        double const before = disk_p99_ms(dir / "alone");
        SessionOutcome const o = run_session(s, 1, p, settings_in(dir / std::to_string(attempt)));
        double const after = disk_p99_ms(dir / "alone");
        ASSERT_TRUE(o.is_complete);
        ASSERT_GE(o.bookkeeping_ms.size(), 600u);
        double const p99 = gi::quantile(o.bookkeeping_ms, 0.99), unsynced = gi::quantile(o.unsynced_ms, 0.99);
        fmt::print("{} trials: bookkeeping {:.3f} ms median, {:.3f} ms p99; without waiting for the disk {:.3f} "
                   "ms median, "
                   "{:.3f} ms p99; the disk alone {:.3f} ms p99 before, {:.3f} ms after\n",
                   o.bookkeeping_ms.size(), gi::quantile(o.bookkeeping_ms, 0.5), p99,
                   gi::quantile(o.unsynced_ms, 0.5), unsynced, before, after);
        EXPECT_LT(unsynced, 1);
        if (p99 < 1) return;
        was_quiet = was_quiet || std::max(before, after) < 0.5;
    }
    EXPECT_FALSE(was_quiet) << "the disk was quick enough, the bookkeeping was not";
    if (!was_quiet)
        GTEST_SKIP() << "the disk alone takes too long on this machine, or something else keeps it busy";
}

} // namespace
} // namespace study::test
