// Whole analyses of published data against what other programs say of them.

#include "tests/study_analysis/made_sessions.h"
#include "tests/study_stats/support/study_data.h"

#include <fmt/format.h>

namespace study::test {
namespace {

int index_in(std::vector<FactorLevel> const& levels, std::string const& name)
{
    for (std::size_t i = 0; i < levels.size(); ++i)
        if (levels[i].name == name) return int(i);
    return -1;
}

TEST(Analysis, OfTheToneMappingPairsHasTheScaleOfPwcmp)
{
    LIGHTWELL_NEED_STUDY_DATA();
    Script const script = parse_script(R"(schema: study/1
id: tmo
seed: 1
participants: {count: 18}
factors:
  scene: [corridor, exhibition, rivoli, students, window]
  tmo: [ferwerda96, hateren06, irawan05, mantiuk08, pattanaik00, ronan12, tmo_camera]
sequence: [pairs]
blocks: {pairs: {task: pair, pairs: {factor: tmo}, cross: [scene]}}
)",
                                       "tmo.yaml");
    std::map<std::string, MadeSession> people;
    auto const rows = read_csv("pairs_tmo_video.csv");
    for (std::size_t r = 1; r < rows.size(); ++r) {
        auto const& row = rows[r];
        MadeSession& s = people.try_emplace(row[0], script, row[0]).first->second;
        int const scene = index_in(script.factors[0].levels, row[2]);
        s.add(0,
              {{scene, index_in(script.factors[1].levels, row[3])},
               {scene, index_in(script.factors[1].levels, row[4])}},
              row[5] == "1" ? "first" : "second");
    }
    std::vector<RecordedSession> sessions;
    for (auto& [name, s] : people) sessions.push_back(s.finished());
    AnalysisSettings settings;
    settings.replicates = 100;
    Analysis const a = analyze(script, sessions, settings);

    ASSERT_EQ(a.blocks.size(), 1u);
    ASSERT_EQ(a.blocks[0].scales.size(), 6u) << "all scenes, and each";
    ScaleResult const& all = a.blocks[0].scales[0];
    EXPECT_EQ(all.group, "all");
    EXPECT_EQ(all.refused, "");
    EXPECT_EQ(all.observers, 18);
    EXPECT_EQ(all.observations, 1213);
    std::vector<double> const jod{-.10859, -1.39044, 1.04492, .60747, -.56235, .03909, .36989};
    auto const expected = read_json("pairs_tmo_video.expected.json")["all"];
    for (std::size_t i = 0; i < jod.size(); ++i) {
        EXPECT_NEAR(all.items[i].score.value, jod[i], 1e-4) << all.items[i].name;
        EXPECT_LT(all.items[i].score.interval.low, jod[i]);
        EXPECT_GT(all.items[i].score.interval.high, jod[i]);
        EXPECT_NEAR(fact(all, "Bradley-Terry JOD " + all.items[i].name),
                    double(expected["bradley_terry"]["scale_mean0"][i]) / std::log(3), 1e-6);
    }
    EXPECT_NEAR(fact(all, "Bradley-Terry deviance"), double(expected["bradley_terry"]["deviance"]), 1e-6);
    EXPECT_EQ(fact(all, "Bradley-Terry deviance df"), double(expected["bradley_terry"]["df"]));
    std::map<std::string, double> const outliers{
        {"bab", 4.4665}, {"M02", 3.4505}, {"M06", 0.8786}, {"F01", 0.3535}};
    for (ObserverSummary const& o : a.observers)
        EXPECT_NEAR(o.outlier_score.at("pairs"), outliers.contains(o.participant) ? outliers.at(o.participant) : 0,
                    1e-3)
            << o.participant;

    settings.exclude = {"bab"};
    Analysis const without = analyze(script, sessions, settings);
    EXPECT_EQ(without.blocks[0].scales[0].observers, 17);
    settings.exclude = {"nobody"};
    EXPECT_THROW(analyze(script, sessions, settings), gi::InputError);
}

TEST(Analysis, OfRatingsHasTheMeansAndFriedmansTestOfR)
{
    LIGHTWELL_NEED_STUDY_DATA();
    std::string assets;
    for (int i = 0; i < 79; ++i) assets += fmt::format("{}a{}", i ? ", " : "", i);
    Script const script =
        parse_script("schema: study/1\nid: r\nseed: 1\nparticipants: {count: 26}\nfactors: {asset: [" + assets +
                         "]}\nsequence: [rate]\nblocks: {rate: {task: rating, cross: [asset], "
                         "scale: {min: 1, max: 5}}}\n",
                     "r.yaml");
    std::map<std::string, MadeSession> people;
    auto const rows = read_csv("ratings_nflx_public.csv");
    for (std::size_t r = 1; r < rows.size(); ++r) {
        MadeSession& s = people.try_emplace(rows[r][2], script, rows[r][2]).first->second;
        s.add(0, {{std::stoi(rows[r][0])}}, "", std::stod(rows[r][3]));
    }
    std::vector<RecordedSession> sessions;
    for (auto& [name, s] : people) sessions.push_back(s.finished());
    Analysis const a = analyze(script, sessions);
    ScaleResult const& all = a.blocks.at(0).scales.at(0);
    auto const expected = read_json("ratings_nflx_public.expected.json");
    double sum = 0;
    for (std::size_t i = 0; i < 79; ++i) {
        EXPECT_NEAR(all.items[i].score.value, double(expected["mos"][i]), 1e-9);
        sum += all.items[i].score.value;
    }
    EXPECT_NEAR(sum / 79, 3.544791, 1e-6);
    EXPECT_NEAR(fact(all, "Friedman chi-square"), 1571.854, 1e-3);
    EXPECT_EQ(fact(all, "Friedman df"), 78);
}

} // namespace
} // namespace study::test
