// How methods are compared: times at equal error, ratios, lost rows; the list of scenes.

#include "gi/core/error.h"
#include "tests/viewer/run_program.h"
#include "viewer/bench/pictures_list.h"
#include "viewer/bench/pictures_plan.h"
#include "viewer/bench/pictures_score.h"
#include "viewer/report/picture_summary.h"

#include <cmath>

namespace viewer::test {
namespace {

TEST(TimeAtError, IsInterpolatedOnLogarithmicAxes)
{
    // error = 0.1 / time, and from 1 s on 0.1 / sqrt(time)
    std::vector<ErrorAtTime> const curve{{1, 0.1}, {0.1, 1}, {16, 0.025}};
    TimeAtError const steep = time_at_error(curve, 0.5), flat = time_at_error(curve, 0.05);
    EXPECT_EQ(steep.reached, Reached::between_budgets);
    EXPECT_NEAR(steep.seconds, 0.2, 1e-9);
    EXPECT_NEAR(flat.seconds, 4, 1e-9);
    EXPECT_NEAR(time_at_error(curve, 0.1).seconds, 1, 1e-9);
    EXPECT_NEAR(time_at_error(curve, 0.025).seconds, 16, 1e-9);
}

TEST(TimeAtError, SaysWhereItIsBeyondTheCurve)
{
    std::vector<ErrorAtTime> const curve{{1, 0.1}, {4, 0.05}};
    TimeAtError const later = time_at_error(curve, 0.025);
    EXPECT_EQ(later.reached, Reached::beyond_budgets);
    EXPECT_NEAR(later.seconds, 16, 1e-9);
    TimeAtError const first = time_at_error(curve, 0.2);
    EXPECT_EQ(first.reached, Reached::in_first_picture);
    EXPECT_EQ(first.seconds, 1);
}

TEST(TimeAtError, IsUnknownWhereErrorsDoNotFall)
{
    for (auto const& curve : std::vector<std::vector<ErrorAtTime>>{
             {}, {{1, 0.1}}, {{1, 0.1}, {2, 0.1}}, {{1, 0.1}, {1, 0.05}}, {{0, 0.1}, {2, std::nan("")}}}) {
        TimeAtError const t = time_at_error(curve, 0.01);
        EXPECT_EQ(t.reached, Reached::never);
        EXPECT_TRUE(std::isnan(t.seconds));
    }
    EXPECT_EQ(time_at_error({{1, 0.1}, {2, 0.05}}, -0.01).reached, Reached::never);
}

/// A peer whose relMSE is 0.1 / s and whose FLIP is 0.1 / sqrt(s).
BenchTable some_pictures()
{
    BenchTable t{"pictures", {"scene", "budget", "method", "filter", "total_s", "relmse", "flip"}};
    auto const add = [&](char const* scene, char const* budget, char const* method, double s, double relmse,
                         double flip) {
        t.add(
            {std::string(scene), std::string(budget), std::string(method), std::string("none"), s, relmse, flip});
    };
    for (char const* scene : {"hall", "yard"}) {
        add(scene, "1s", "reference", 1, 0.1, 0.1);
        add(scene, "4s", "reference", 4, 0.025, 0.05);
    }
    add("hall", "1s", "slhb", 1, 0.05, 0.2);
    add("hall", "4s", "slhb", 4, 0.0253, 0.05);
    add("yard", "1s", "slhb", 0.5, 0.4, 0.1);
    add("nowhere", "1s", "slhb", 1, 1, 1);
    return t;
}

TEST(PictureSummary, ComparesWithThePeerWorstFirst)
{
    std::vector<PictureContest> const c = contests(some_pictures(), "reference");
    ASSERT_EQ(c.size(), 3u) << "there is no peer nowhere";
    EXPECT_EQ(c[0].scene, "yard");
    EXPECT_NEAR(c[0].relmse_ratio, 4, 1e-9);
    EXPECT_EQ(c[0].relmse_reached, Reached::in_first_picture);
    EXPECT_NEAR(c[0].relmse_time_factor, 2, 1e-9);
    EXPECT_NEAR(c[0].time_ratio, 0.5, 1e-9);
    EXPECT_EQ(c[1].budget, "1s");
    EXPECT_NEAR(c[1].relmse_ratio, 0.5, 1e-9);
    EXPECT_NEAR(c[1].flip_ratio, 2, 1e-9);
    EXPECT_NEAR(c[1].relmse_time_factor, 2, 1e-9);
    EXPECT_EQ(c[1].relmse_reached, Reached::between_budgets);
    EXPECT_EQ(c[2].budget, "4s");
    EXPECT_FALSE(c[2].lost()) << "1.2 % is not counted";

    std::vector<LostRows> const lost = lost_rows(c);
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_EQ(lost[0].rows, 3);
    EXPECT_EQ(lost[0].relmse, 1);
    EXPECT_EQ(lost[0].flip, 1);
    EXPECT_EQ(lost[0].either, 2);

    BenchTable summary{"pictures_summary", picture_summary_columns("reference")};
    fill_picture_summary(c, "reference", summary);
    EXPECT_EQ(summary.rows.size(), 3u);
    EXPECT_EQ(summary.facts.at(0).second, "2 of 3 (relMSE 1, FLIP 1)");
}

TEST(PictureScore, MeansHaveStandardErrors)
{
    MeanOf const m = mean_of({1, 2, 3}, 0);
    EXPECT_NEAR(number(m.value), 2, 1e-12);
    EXPECT_NEAR(number(m.error), 1 / std::sqrt(3), 1e-12);
    EXPECT_NEAR(number(mean_of({1, 2, 3}, 1).error), std::sqrt(4.0 / 3), 1e-12);
    EXPECT_TRUE(std::isnan(number(mean_of({1}, 0).error)));
    EXPECT_TRUE(std::isnan(number(mean_of({}, 0).value)));
}

TEST(PictureScore, TakesOffTheNoiseOfTheReference)
{
    gi::Picture truth{4, 4, {}, {}};
    std::ranges::fill(truth.add("color", 3).data, 1.0f);
    std::ranges::fill(truth.add("variance", 3).data, 0.16f);
    gi::Picture picture = truth;
    std::ranges::fill(picture.find("color")->data, 1.5f);
    double const unit = 1 / 1.01; // 1 / (r^2 + 0.01)
    PictureScore const s = score(picture, {truth, 0.16 * unit, ""});
    EXPECT_NEAR(s.relmse, (0.25 - 0.16) * unit, 1e-6);
    EXPECT_NEAR(s.bias[0], 1.5, 1e-6);
    EXPECT_TRUE(std::isnan(s.bias[1]));
    EXPECT_NEAR(bias_errors(truth)[0], std::sqrt(0.16 / 16), 1e-6);
}

TEST(PictureBudgets, ArePathsOrTimes)
{
    EXPECT_EQ(parse_picture_budget("1path").paths, 1u);
    EXPECT_EQ(parse_picture_budget("16paths").paths, 16u);
    EXPECT_NEAR(parse_picture_budget("300ms").seconds, 0.3, 1e-12);
    for (char const* wrong : {"path", "0path", "-1paths", "1.5paths", "99999999999paths", "soon"})
        EXPECT_THROW(parse_picture_budget(wrong), gi::InputError) << wrong;
}

RenderOptions const kCommon;

std::vector<ListedScene> list_of(TemporaryFolder const& folder, std::string const& text)
{
    std::ofstream(folder / "list.yaml") << text;
    return read_scene_list(folder / "list.yaml", kCommon);
}

TEST(SceneList, IsReadBesideItsFiles)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "hall.yaml") << "models: []";
    auto const list =
        list_of(folder, "scenes:\n"
                        "  - {name: hall, file: hall.yaml, camera: door, time: 0.5, fov: 40}\n"
                        "  - {name: box, built_in: cornell, look_from: [1, 2, 3.5], look_at: [0, 0, 0]}\n"
                        "  - {name: gone, file: hall.yaml, envmap: sky.hdr, envmap_rotate: 90}\n");
    ASSERT_EQ(list.size(), 3u);
    EXPECT_EQ(list[0].options.scene, (folder / "hall.yaml").string());
    EXPECT_EQ(list[0].options.camera, "door");
    EXPECT_EQ(list[0].options.time_s, 0.5);
    EXPECT_TRUE(list[0].missing.empty());
    EXPECT_EQ(list[1].options.scene, "cornell");
    EXPECT_EQ(list[1].options.look_from, "1,2,3.5");
    EXPECT_EQ(list[2].missing, (folder / "sky.hdr").string());
    EXPECT_EQ(list[2].options.environment_rotate_deg, 90);

    auto const chosen = choose_scenes(list, {"box", "atrium"}, kCommon);
    ASSERT_EQ(chosen.size(), 2u);
    EXPECT_EQ(chosen[0].options.scene, "cornell");
    EXPECT_EQ(chosen[1].options.scene, "atrium");
    EXPECT_THROW(choose_scenes(list, {"cellar"}, kCommon), gi::InputError);
}

TEST(SceneList, RefusesWhatIsWrong)
{
    TemporaryFolder const folder;
    for (char const* wrong :
         {"", "scenes: []", "rooms: []", "sequences: []", "scenes: [{file: a.glb}]", "scenes: [{name: a}]",
          "scenes: [{name: a, file: a, built_in: cornell}]", "scenes: [{name: a/b, built_in: cornell}]",
          "scenes: [{name: a, built_in: palace}]", "scenes: [{name: a, built_in: cornell, colour: red}]",
          "scenes: [{name: a, built_in: cornell}, {name: a, built_in: atrium}]",
          "scenes: [{name: a, built_in: cornell, camera_path: path.yaml}]"})
        EXPECT_THROW(list_of(folder, wrong), gi::InputError) << wrong;
}

/// Every scene of the shipped list has its own small file, or is built in.
TEST(SceneList, ShippedOneIsRead)
{
    auto const list = read_scene_list(LIGHTWELL_SOURCE_DIR "/data/pictures.yaml", kCommon);
    EXPECT_EQ(read_scene_list(LIGHTWELL_SOURCE_DIR "/data/pictures.yaml", kCommon, Listed::sequences).size(), 4u);
    EXPECT_GE(list.size(), 9u);
    for (ListedScene const& s : list) EXPECT_TRUE(s.missing.empty()) << s.missing;
}

} // namespace
} // namespace viewer::test
