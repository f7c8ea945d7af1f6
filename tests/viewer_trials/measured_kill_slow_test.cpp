// kill -9 at random moments of sessions in a window, with a display model, gaze, and markers: nothing is lost.

#include "tests/viewer_trials/measured_session.h"

#include <algorithm>
#include <random>
#include <set>

namespace viewer::test {
namespace {

class MeasuredKills : public OnScreen {
protected:
    TemporaryFolder folder;
};

/// Trials of which a row of gaze is in one of the tables.
std::set<int> steps_with_gaze(std::filesystem::path const& folder)
{
    std::set<int> steps;
    for (auto const& entry : std::filesystem::directory_iterator(folder)) {
        if (!entry.path().filename().string().ends_with("_gaze.csv")) continue;
        std::istringstream lines(file_text(entry.path()));
        for (std::string line; std::getline(lines, line);) {
            std::istringstream cells(line);
            std::string cell;
            for (int i = 0; i < 6; ++i) std::getline(cells, cell, ',');
            if (!cell.empty() && std::isdigit(static_cast<unsigned char>(cell[0]))) steps.insert(std::stoi(cell));
        }
    }
    return steps;
}

TEST_F(MeasuredKills, LoseNoTrialAndNoGazeOfIt)
{
    constexpr int kKills = 100;
    bool const has_lsl = !peer_lsl().empty();
    if (has_lsl) setenv("PYLSL_LIB", peer_lsl().c_str(), 1);
    calibrated(folder);
    write_gaze(folder, 2.5);
    // Trials without an answer count as done: nobody needs to press keys.
    std::string text = measured_script("repeats: 400, stimulus_ms: 60, timeout_ms: 80, min_response_ms: 0",
                                       has_lsl ? "[udp, lsl]" : "[udp]", "[seen]");
    text.replace(text.find("max_dropped_frames"), 0, "on_bad_trial: keep, ");
    std::mt19937 random(20261126);
    int kills = 0, proven = 0, kept = 0;
    bool has_ended = false;
    while (kills < kKills && !has_ended) {
        RunningSession run(folder, text,
                           std::string("--display-model model.yaml --gaze gaze.csv") +
                               (kills > 0 ? " --resume" : ""));
        // Before a trial begins, all before it are on the disk.
        std::set<std::pair<int, int>> begun;
        std::pair<int, int> last{-1, 0};
        int const wanted = int(random() % 8);
        for (int i = 0; i <= wanted; ++i) {
            Json const trial = run.markers.wait_for("trial", std::chrono::seconds(20));
            if (!trial.is_object()) break;
            if (last.first >= 0) begun.insert(last);
            last = {trial.at("step").get<int>(), trial.at("attempt").get<int>()};
        }
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 150000));
        has_ended = !run.program().runs();
        run.program().send(SIGKILL);
        Outcome const o = run.wait();
        if (last.first < 0) ADD_FAILURE() << "no trial: " << o.err;
        ++kills;
        proven += int(begun.size());
        std::set<std::pair<int, int>> recorded;
        std::set<int> with_stimuli;
        for (study::TrialDone const& t : run.entries<study::TrialDone>()) {
            EXPECT_TRUE(recorded.insert({t.step, t.attempt}).second) << "twice";
            if (!t.shown.empty()) with_stimuli.insert(t.step);
        }
        for (auto const& [step, attempt] : begun)
            EXPECT_TRUE(recorded.contains({step, attempt})) << "step " << step << " was lost";
        std::set<int> const seen = steps_with_gaze(run.folder());
        for (int const step : with_stimuli) EXPECT_TRUE(seen.contains(step)) << "no gaze of step " << step;
        kept = int(recorded.size());
    }
    EXPECT_EQ(kills, kKills);
    fmt::print("{} kills, {} trials kept, {} of them proven done before a kill, 0 lost; LSL {}\n", kills, kept,
               proven, has_lsl ? "on" : "absent");
    run_well("study rebuild data --script x.yaml", folder.path());
    EXPECT_TRUE(std::filesystem::exists(
        folder / "data/sub-P001/ses-01/beh/sub-P001_ses-01_task-session_recording-eye1_physio.tsv.gz"));
}

} // namespace
} // namespace viewer::test
