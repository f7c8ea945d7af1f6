// Dwell on the objects of a known scene: a red and a green wall with an edge in the middle of the picture, above the
// green one a mirror that shows a blue wall behind the camera.

#include "gi/scene/generate/builder.h"
#include "study/display/geometry.h"
#include "study/script/script_file.h"
#include "study/tables/bids.h"
#include "tests/study_tables/recorded.h"
#include "viewer/experiment/looked/gaze_rays.h"
#include "viewer/experiment/looked/looked_at.h"
#include "viewer/experiment/stimuli/stimulus_settings.h"
#include "viewer/experiment/stimuli/study_scenes.h"

#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

study::ScreenGeometry const kScreen{1920, 1080, 53.1, 29.87, 57.3, "typed"};

gi::Material silver()
{
    gi::Material m = gi::matt(gi::vec3{0.95f});
    m.metallic = 1;
    m.roughness = 0;
    return m;
}

gi::Scene walls()
{
    gi::SceneBuilder b;
    b.quad(b.add_material("red", gi::matt({0.6f, 0.1f, 0.1f})), {-4, -3, -2}, {4, 0, 0}, {0, 6, 0});
    b.quad(b.add_material("green", gi::matt({0.1f, 0.6f, 0.1f})), {0, -3, -2}, {4, 0, 0}, {0, 3, 0});
    b.quad(b.add_material("mirror", silver()), {0, 0, -2}, {4, 0, 0}, {0, 3, 0});
    b.quad(b.add_material("blue", gi::matt({0.1f, 0.1f, 0.6f})), {20, -20, 2}, {-40, 0, 0}, {0, 40, 0});
    b.add_camera("front", {0, 0, 0}, {0, 0, -1}, 40);
    return b.finish("walls");
}

class LookedAtWalls : public testing::Test {
protected:
    LookedAtWalls()
    {
        records_.script = study::parse_script(R"(schema: study/1
id: looks
seed: 5
participants: {count: 2}
factors: {paths: [1, 2]}
sequence: [seen]
defaults: {settings: {scene: walls}}
blocks:
  seen: {task: rating, scale: {min: 1, max: 7}, cross: [paths], stimulus_ms: 2000}
)",
                                              "t.yaml");
        scenes_ = study_scenes();
        scenes_.load = [this](std::string const&, gi::Report&) {
            ++loads_;
            return std::make_shared<gi::Scene const>(walls());
        };
    }
    ~LookedAtWalls() override { fs::remove_all(dir_); }

    /// Gaze that is at each place (degrees to the right and down) for so long, in every trial. The picture is in a
    /// rectangle of the screen.
    void record(std::vector<std::array<double, 3>> const& looks_ms, glm::ivec4 rectangle = {0, 0, 1920, 1080})
    {
        study::RecordedSession session = study::test::record_session(
            records_.script, 1, [&](study::PlanStep const& step, study::TrialDone& done) {
                done.response = "4";
                done.value = 4;
                for (study::StimulusShown& s : done.shown) {
                    s.left_px = rectangle.x;
                    s.top_px = rectangle.y;
                    s.width_px = rectangle.z;
                    s.height_px = rectangle.w;
                    study::Block const& block = records_.script.blocks[std::size_t(step.block)];
                    s.settings_sha256 = stimulus_settings(records_.script, block, step.trial.stimuli[0]).sha256;
                }
            });
        auto& start = std::get<study::SessionStarted>(session.record.entries.front());
        start.about = {{"screen_px", "1920 x 1080"},
                       {"screen_cm", "53.10 x 29.87"},
                       {"window_px", "1920 x 1080"},
                       {"viewing_distance_cm", "57.3"},
                       {"gaze_table", "g.csv"}};
        fs::path const folder = dir_ / study::session_folder(start);
        fs::create_directories(folder);
        std::ofstream out(folder / "g.csv");
        out << "t_s,x_px,y_px,pupil_mm,valid,step,shown\n";
        for (study::JournalEntry const& entry : session.record.entries)
            if (auto const* const t = std::get_if<study::TrialDone>(&entry)) {
                double at = t->shown[0].onset_s;
                for (auto const& [x, y, ms] : looks_ms)
                    for (double const end = at + 1e-3 * ms; at < end - 1e-6; at += 0.001)
                        out << fmt::format("{:.6f},{:.4f},{:.4f},3,1,{},a\n", at + 1e-5,
                                           960 + study::px_of_place(kScreen, x, false),
                                           540 + study::px_of_place(kScreen, y, true), t->step);
            }
        records_.sessions = {std::move(session)};
    }

    LookedAt looked(LookedAtSettings const& settings)
    {
        analysis_ = study::analyse_gaze(study::gaze_of_records(dir_, records_, {}, {}), {});
        return looked_at(records_, analysis_, scenes_, settings);
    }
    /// Seconds of the first condition on this.
    static std::array<double, 3> on(LookedAt const& l, std::string const& kind, std::string const& name)
    {
        for (auto const& row : l.tables.at(0).table.rows)
            if (row[2] == kind && row[3] == name) return {std::stod(row[4]), std::stod(row[5]), std::stod(row[8])};
        return {};
    }
    static double shares(LookedAt const& l, std::string const& kind)
    {
        double sum = 0;
        for (auto const& row : l.tables.at(0).table.rows)
            if (row[1] == l.tables[0].table.rows[0][1] && (row[2] == kind || row[2] == "none"))
                sum += std::stod(row[6]);
        return sum;
    }
    double fixated(std::size_t i) const { return analysis_.recordings.at(0)->views.at(0).fixations.at(i).dwell_s; }

    fs::path dir_ = fs::temp_directory_path() / fmt::format("lightwell_looked_{}", getpid());
    study::Dataset records_;
    SceneAccess scenes_;
    study::GazeAnalysis analysis_;
    int loads_ = 0;
};

TEST_F(LookedAtWalls, DwellIsThatOfTheFixationsAndFollowsTheMirror)
{
    record({{-6, 2, 1000}, {6, 4, 600}, {6, -4, 400}});
    LookedAt const l = looked({});
    fmt::print("red {:.4f} of {:.4f} s, green {:.4f} of {:.4f} s, blue in the mirror {:.4f} of {:.4f} s\n",
               on(l, "object", "red")[0], fixated(0), on(l, "object", "green")[0], fixated(1),
               on(l, "object", "blue")[0], fixated(2));
    EXPECT_NEAR(fixated(0), 1, 0.02);
    for (char const* const kind : {"object", "material"}) {
        EXPECT_NEAR(on(l, kind, "red")[0] / fixated(0), 1, 0.01);
        EXPECT_NEAR(on(l, kind, "green")[0] / fixated(1), 1, 0.01);
        EXPECT_NEAR(on(l, kind, "blue")[0] / fixated(2), 1, 0.01);
        EXPECT_EQ(on(l, kind, "mirror")[0], 0);
        EXPECT_NEAR(shares(l, kind), 1, 1e-6);
    }
    EXPECT_NEAR(on(l, "object", "blue")[2], fixated(2), 0.01) << "by way of the mirror";
    EXPECT_NEAR(on(l, "object", "red")[1], 0, 1e-6) << "far from all edges, accuracy does not matter";
    EXPECT_EQ(loads_, 1) << "both conditions show the same surfaces";
    ASSERT_EQ(l.surfaces.size(), 1u);
    double seconds = 0;
    for (double const s : l.surfaces[0].seconds) seconds += s;
    EXPECT_NEAR(seconds, 2 * (fixated(0) + fixated(1) + fixated(2)), 0.02) << "of both trials";
    EXPECT_TRUE(l.tables.at(3).table.rows.empty());
}

TEST_F(LookedAtWalls, NearAnEdgeTheShareIsThatOfTheAccuracy)
{
    for (double const deg : {-0.5, 0.25, 1.0}) {
        record({{deg, 5, 2000}});
        LookedAtSettings settings;
        settings.accuracy_deg = 0.5;
        LookedAt const l = looked(settings);
        double const expected = 0.5 * std::erfc(-deg / 0.5 / std::sqrt(2.0));
        auto const green = on(l, "object", "green");
        fmt::print("{:+.2f} degrees from the edge: green {:.4f} +- {:.4f} s, expected {:.4f}\n", deg, green[0],
                   green[1], expected * fixated(0));
        EXPECT_NEAR(green[0] / fixated(0), expected, 0.01);
        // One common offset: the whole fixation is on one or the other.
        EXPECT_NEAR(green[1] / fixated(0), std::sqrt(expected * (1 - expected)), 0.03);
    }
}

TEST_F(LookedAtWalls, AMovingCameraIsThatOfEachMoment)
{
    // Once round a circle to the right, out and back: gaze in the middle of the picture is on green while
    // the camera is to the right of the edge, the first half of the time, and on red otherwise.
    records_.script.blocks[0].camera = "path:orbit";
    record({{-0.02, 5, 2000}});
    LookedAt const l = looked({0, 1, 0});
    fmt::print("red {:.4f} s, green {:.4f} s of {:.4f} s\n", on(l, "object", "red")[0], on(l, "object", "green")[0],
               fixated(0));
    EXPECT_NEAR(on(l, "object", "green")[0] / fixated(0), 0.5, 0.02);
    EXPECT_NEAR(on(l, "object", "red")[0] / fixated(0), 0.5, 0.02);
}

TEST_F(LookedAtWalls, BesideThePictureIsCounted)
{
    record({{-6, 2, 1000}, {6, 4, 1000}}, {480, 0, 480, 1080}); // the left half of the middle
    LookedAt const l = looked({0.1, 64, 0});
    EXPECT_NEAR(on(l, "none", "beside the picture")[0] / fixated(1), 1, 0.01);
    EXPECT_NEAR(on(l, "object", "red")[0] + on(l, "object", "green")[0], fixated(0), 0.01);
}

TEST_F(LookedAtWalls, WhatCannotBeFollowedIsCounted)
{
    record({{-6, 2, 2000}});
    for (study::JournalEntry& entry : records_.sessions[0].record.entries)
        if (auto* const t = std::get_if<study::TrialDone>(&entry)) {
            t->shown[0].settings_sha256 = "of something else";
            break;
        }
    LookedAt l = looked({});
    ASSERT_EQ(l.tables.at(3).table.rows.size(), 1u);
    EXPECT_EQ(l.tables[3].table.rows[0][0], "its settings are not those recorded");
    EXPECT_EQ(l.tables[3].table.rows[0][1], "1");
    ASSERT_EQ(l.cautions.size(), 1u);
    for (study::JournalEntry& entry : records_.sessions[0].record.entries)
        if (auto* const t = std::get_if<study::TrialDone>(&entry)) t->shown[0].left_px.reset();
    l = looked({});
    EXPECT_EQ(l.tables[3].table.rows.at(0)[1], "2");
    EXPECT_TRUE(l.surfaces.empty());
}

TEST(GazeRays, EndBetweenTwoMirrors)
{
    gi::SceneBuilder b;
    int const m = b.add_material("mirror", silver());
    b.quad(m, {-5, -5, -2}, {10, 0, 0}, {0, 10, 0});
    b.quad(m, {5, -5, 2}, {-10, 0, 0}, {0, 10, 0});
    gi::Report report;
    gi::World const world = gi::build_world(std::make_shared<gi::Scene const>(b.finish("mirrors")), {}, report);
    auto const met =
        GazeRays(world, 0).meet({{gi::vec3{0.1f, 0.1f, 0}, gi::vec3{0, 0, -1}},
                                 {gi::vec3{0.1f, 0.1f, 0}, glm::normalize(gi::vec3{0.7f, 0.1f, -0.5f})},
                                 {gi::vec3{0, 0, 10}, gi::vec3{0, 0, 1}}});
    EXPECT_TRUE(met[0].is_cut);
    EXPECT_EQ(met[0].mirrors, kMostGazeMirrors);
    EXPECT_FALSE(met[1].is_cut);
    EXPECT_EQ(met[1].triangle, gi::kNoTriangle) << "it leaves at the side";
    EXPECT_EQ(met[1].mirrors, 1);
    EXPECT_EQ(met[2].mirrors, 0);
}

TEST(SurfaceHeat, IsPlyWithSecondsPerSquareMetre)
{
    SurfaceHeat heat;
    heat.scene = "one";
    heat.origin = {100, 0, 0};
    heat.corners = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    heat.seconds = {1, 0};
    EXPECT_DOUBLE_EQ(heat.most(), 0.5);
    fs::path const file = fs::temp_directory_path() / fmt::format("lightwell_heat_{}.ply", getpid());
    write_heat_ply(file, heat);
    std::ifstream in(file, std::ios::binary);
    std::string const text{std::istreambuf_iterator<char>(in), {}};
    fs::remove(file);
    std::size_t const header = text.find("end_header\n") + 11;
    EXPECT_EQ(text.size(), header + 6 * 24 + 2 * (1 + 12 + 8 + 3));
    EXPECT_NE(text.find("property float seconds_per_m2"), std::string::npos);
    float density = 0;
    std::memcpy(&density, text.data() + header + 6 * 24 + 1 + 12 + 4, sizeof density);
    EXPECT_EQ(density, 0.5f);
}

} // namespace
} // namespace viewer::test
