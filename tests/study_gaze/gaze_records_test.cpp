// Gaze that sessions recorded, with their trials.

#include "study/gaze/gaze_analysis.h"
#include "study/gaze/gaze_heat.h"
#include "study/gaze/gaze_tables.h"
#include "study/script/script_file.h"
#include "study/tables/bids.h"
#include "tests/study_gaze/simulated_gaze.h"
#include "tests/study_tables/recorded.h"

#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace study::test {
namespace {

namespace fs = std::filesystem;

/// Trials one by one; in each gaze is at (200, 100) px from the middle of the window for its first half, then at
/// (-300, 0).
class RecordedGaze : public testing::Test {
protected:
    RecordedGaze()
    {
        records_.script = parse_script(R"(schema: study/1
id: looks
seed: 5
participants: {count: 2}
factors: {scene: [cornell, arches]}
sequence: [better]
blocks:
  better: {task: rating, scale: {min: 1, max: 7}, cross: [scene], stimulus_ms: 2000}
)",
                                       "t.yaml");
        for (int participant = 1; participant <= 2; ++participant) {
            RecordedSession session =
                record_session(records_.script, participant, [](auto const&, TrialDone& done) {
                    done.response = "4";
                    done.value = 4;
                });
            auto& start = std::get<SessionStarted>(session.record.entries.front());
            start.about = {{"screen_px", "1920 x 1080"},
                           {"screen_cm", "53.10 x 29.87"},
                           {"window_px", "1280 x 720"},
                           {"gaze_table", "g.csv"}};
            if (participant == 1) start.about.emplace_back("viewing_distance_cm", "57.3");
            write_samples(session);
            records_.sessions.push_back(std::move(session));
        }
    }
    ~RecordedGaze() override { fs::remove_all(dir_); }

    void write_samples(RecordedSession const& session)
    {
        fs::path const folder = dir_ / session_folder(start_of(records_.script, session));
        fs::create_directories(folder);
        std::ofstream out(folder / "g.csv");
        out << "t_s,x_px,y_px,pupil_mm,valid,step,shown\n";
        int trials = 0;
        for (JournalEntry const& entry : session.record.entries)
            if (auto const* const t = std::get_if<TrialDone>(&entry))
                for (StimulusShown const& s : t->shown) {
                    bool const is_bad = ++trials == 2;
                    for (int i = 0; i < 500; ++i) {
                        double const at = s.onset_s + 0.004 * i + 1e-4;
                        bool const first = i < 250;
                        if (is_bad && i % 2)
                            out << fmt::format("{:.6f},,,,0,{},a\n", at, t->step);
                        else
                            out << fmt::format("{:.6f},{},{},3,1,{},a\n", at, 640 + (first ? 200 : -300),
                                               360 + (first ? 100 : 0), t->step);
                    }
                }
        out << "cut off";
    }

    fs::path dir_ = fs::temp_directory_path() / fmt::format("lightwell_recorded_gaze_{}", getpid());
    Dataset records_;
};

TEST_F(RecordedGaze, IsJoinedWithItsTrials)
{
    GazeRecordings all = gaze_of_records(dir_, records_, {}, {});
    ASSERT_EQ(all.recordings.size(), 1u) << "the other one has no distance";
    ASSERT_EQ(all.remarks.size(), 3u);
    EXPECT_NE(all.remarks[0].find("1 lines that are no samples"), std::string::npos) << all.remarks[0];
    EXPECT_NE(all.remarks[2].find("sub-P002_ses-01: left out"), std::string::npos) << all.remarks[2];
    EXPECT_EQ(all.recordings[0].counts.unreadable, 1);
    EXPECT_EQ(gaze_of_records(dir_, records_, kGazeScreen, {}).recordings.size(), 2u) << "--display-model";
    EXPECT_EQ(gaze_of_records(dir_, records_, kGazeScreen, {"P001"}).recordings.size(), 1u);

    GazeAnalysis const a = analyse_gaze(std::move(all), {});
    auto const& views = a.recordings[0]->views;
    ASSERT_EQ(views.size(), 2u);
    EXPECT_NE(views[0].view->condition, views[1].view->condition);
    EXPECT_TRUE(views[0].is_usable);
    EXPECT_FALSE(views[1].is_usable);
    EXPECT_NEAR(views[0].valid_share, 1, 0.01);
    EXPECT_NEAR(views[1].valid_share, 0.5, 0.01);
    ASSERT_EQ(views[0].fixations.size(), 2u);
    EXPECT_NEAR(views[0].fixations[0].fixation->x_px, 200, 1e-6) << "from the centre of the window";
    EXPECT_NEAR(views[0].fixations[0].dwell_s + views[0].fixations[1].dwell_s, 2, 0.02);
    ASSERT_EQ(views[0].saccades.size(), 1u);
    EXPECT_NEAR(views[0].first_saccade_ms, 1000, 12);
    EXPECT_NEAR(views[0].path_deg, deg_between(kGazeScreen, {200, 100}, {-300, 0}), 0.01);

    for (ResultTable const& t : gaze_tables(a))
        for (auto const& row : t.table.rows) EXPECT_EQ(row.size(), t.table.columns.size()) << t.name;
}

TEST_F(RecordedGaze, HasAHeatMapOfEachConditionThatCounts)
{
    GazeAnalysis const a = analyse_gaze(gaze_of_records(dir_, records_, kGazeScreen, {"P002"}), {});
    auto const maps = condition_heat(a, 1.5, 192);
    ASSERT_EQ(maps.size(), 1u) << "the other one has too few valid samples";
    EXPECT_NEAR(maps[0].seconds, 2, 0.02);
    HeatMap const& map = maps[0].map;
    ASSERT_EQ(map.height, 108);
    // The sum over the screen's solid angle is the time of the fixations.
    double sum = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            auto const d = direction_of_place(kGazeScreen, {10 * (x + 0.5) - 960, 10 * (y + 0.5) - 540});
            double const cell_cm2 = 53.1 / 192 * 29.87 / 108;
            double const steradians = cell_cm2 * std::pow(d[2], 3) / (57.3 * 57.3);
            sum += map.density[std::size_t(y * map.width + x)] * steradians * std::pow(180 / 3.141592653589793, 2);
        }
    EXPECT_NEAR(sum, maps[0].seconds, 0.01);
    auto const at = [&](int x, int y) {
        return map.density[std::size_t((y + 540) / 10 * map.width + (x + 960) / 10)];
    };
    EXPECT_GT(at(200, 100), 0.9 * map.most);
    EXPECT_LT(at(200, -300), 1e-3 * map.most);
    auto const colors = heat_colors(map, map.most);
    EXPECT_EQ(colors.size(), 4 * map.density.size());
    EXPECT_EQ(*std::max_element(colors.begin(), colors.end()), 255);
}

} // namespace
} // namespace study::test
