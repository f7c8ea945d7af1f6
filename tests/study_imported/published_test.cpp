// Published data sets, read as tables of others, must give the published numbers.

#include "study/analysis/analysis.h"
#include "study/imported/trial_table.h"

#include "tests/study_stats/support/study_data.h"

#include <cmath>
#include <fstream>
#include <sstream>

namespace study::test {
namespace {

std::string text_of(std::filesystem::path const& file)
{
    std::ifstream in(file, std::ios::binary);
    std::stringstream s;
    s << in.rdbuf();
    return s.str();
}
std::filesystem::path perceptual() { return study_data().parent_path() / "perceptual"; }

Analysis analysed(std::filesystem::path const& file, ColumnRoles const& roles, AnalysisSettings settings = {})
{
    settings.replicates = 100;
    settings.permutations = 0;
    ImportedTable const t = import_trials(read_delimited(text_of(file), file.string()), roles);
    return analyze(t.script, t.sessions, settings);
}
double named(ScaleResult const& s, std::string const& name)
{
    for (NamedValue const& f : s.facts)
        if (f.name == name) return f.value;
    return kUnknown;
}

TEST(PublishedTables, OfToneMappersHaveTheirJod)
{
    LIGHTWELL_NEED_STUDY_DATA();
    Analysis const a = analysed(study_data() / "pairs_tmo_video.csv", {{{"participant", "observer"},
                                                                        {"first", "condition_A"},
                                                                        {"second", "condition_B"},
                                                                        {"first_chosen", "is_A_selected"}},
                                                                       {"scene"}});
    EXPECT_EQ(a.participants, 18);
    auto const expected = read_json("pairs_tmo_video.expected.json");
    for (ScaleResult const& s : a.blocks.at(0).scales) {
        auto const& e = expected[s.group == "all" ? "all" : s.group.substr(std::string("scene=").size())];
        for (ScaledItem const& item : s.items) {
            std::size_t i = 0;
            while (e["labels"][i] != item.name) ++i;
            EXPECT_NEAR(item.score.value, e["thurstone_case5"]["jod_mean0"][i].get<double>(), 1e-4)
                << s.group << " " << item.name;
        }
        // Deviances of the file are per unordered pair, too.
        EXPECT_NEAR(named(s, "Thurstone V deviance"), e["thurstone_case5"]["deviance"].get<double>(), 1e-4);
    }
    double most = 0;
    for (ObserverSummary const& o : a.observers)
        for (auto const& [block, score] : o.outlier_score)
            if (o.participant == "bab") most = score;
    EXPECT_NEAR(most, 4.4665, 1e-3);
}

TEST(PublishedTables, OfRatingsHaveTheirMeansAndFriedmansTest)
{
    LIGHTWELL_NEED_STUDY_DATA();
    Analysis const a = analysed(study_data() / "ratings_nflx_public.csv",
                                {{{"participant", "subject"}, {"item", "asset_id"}, {"value", "rating"}}, {}});
    auto const e = read_json("ratings_nflx_public.expected.json");
    ScaleResult const& s = a.blocks.at(0).scales.at(0);
    ASSERT_EQ(s.items.size(), 79u);
    EXPECT_NEAR(named(s, "Friedman chi-square"), e["friedman_chi2"].get<double>(), 1e-6);
    for (std::size_t i = 0; i < 79; ++i) EXPECT_NEAR(s.items[i].score.value, e["mos"][i].get<double>(), 1e-8);
}

TEST(PublishedTables, OfCountsAreFittedByMaximumLikelihood)
{
    LIGHTWELL_NEED_STUDY_DATA();
    AnalysisSettings fixed;
    fixed.guess = 0;
    fixed.lapse = 0;
    fixed.draws = 0;
    Analysis const a = analysed(
        study_data() / "psychometric_qpdat.csv",
        {{{"participant", "participant"}, {"level", "phase"}, {"yes_count", "k"}, {"trials", "n"}}, {"cond"}},
        fixed);
    auto const expected = read_json("psychometric_qpdat.expected.json");
    int found = 0;
    for (auto const& e : expected) {
        if (e["link"] != "probit") continue;
        std::string const cell = "cond=" + std::to_string(e["cond"].get<int>());
        for (ThresholdRun const& r : a.blocks.at(0).runs) {
            if (r.participant != e["participant"].get<std::string>() || r.cell != cell) continue;
            ++found;
            EXPECT_NEAR(r.estimates.at(0).level.value / e["threshold50"].get<double>(), 1, 1e-6);
        }
    }
    EXPECT_GE(found, 6);
}

TEST(PublishedTables, OfFlashesSeenHaveTheirThresholds)
{
    LIGHTWELL_NEED_STUDY_DATA();
    if (!std::filesystem::exists(perceptual())) GTEST_SKIP() << "SKIPPED: no reference data at " << perceptual();
    // Hecht, Shlaer & Pirenne 1942: percentages, which are no whole numbers of the N flashes.
    AnalysisSettings fixed;
    fixed.guess = 0;
    fixed.lapse = 0;
    fixed.draws = 0;
    Analysis const a =
        analysed(perceptual() / "psychometric_hsp1942.csv",
                 {{{"participant", "Obs"}, {"run", "Run"}, {"level", "Q"}, {"percent", "p"}, {"trials", "N"}},
                  {},
                  {},
                  Task::yes_no,
                  Scale::log10},
                 fixed);
    std::ifstream in(perceptual() / "reference_fits.json");
    auto const reference = nlohmann::json::parse(in);
    int found = 0;
    for (ThresholdRun const& r : a.blocks.at(0).runs) {
        std::string const key = "hsp_" + r.participant + "_R" + std::to_string(r.run) + "_probit_log10Q";
        if (!reference.contains(key)) continue;
        ++found;
        EXPECT_NEAR(r.estimates.at(0).level.value / reference[key]["threshold_50pct_Q"].get<double>(), 1, 2e-3)
            << key;
    }
    EXPECT_GE(found, 5);
}

TEST(PublishedTables, OfWinsAsAMatrixHaveBradleysAndTerrysAbilities)
{
    LIGHTWELL_NEED_STUDY_DATA();
    if (!std::filesystem::exists(perceptual())) GTEST_SKIP() << "SKIPPED: no reference data at " << perceptual();
    ColumnRoles roles;
    roles.is_matrix = true;
    Analysis const a = analysed(perceptual() / "bt_celebrities_matrix.csv", roles);
    std::ifstream in(perceptual() / "reference_fits.json");
    auto const e = nlohmann::json::parse(in)["celebrities_BT_logit"];
    ScaleResult const& s = a.blocks.at(0).scales.at(0);
    double const jod = 1 / std::log(3.0), reference = named(s, "Bradley-Terry JOD LBJ");
    for (auto const& [name, ability] : e["ability"].items())
        EXPECT_NEAR((named(s, "Bradley-Terry JOD " + name) - reference) / jod, ability.get<double>(), 1e-7)
            << name;
    EXPECT_NEAR(named(s, "Bradley-Terry deviance"), e["deviance"].get<double>(), 1e-6);
    EXPECT_EQ(named(s, "Bradley-Terry deviance df"), 28);
}

TEST(PublishedTables, OfHomeAndAwayGamesHaveTheirOrderEffect)
{
    LIGHTWELL_NEED_STUDY_DATA();
    Analysis const a = analysed(study_data() / "classic" / "classic_baseball.csv", {{{"first", "home.team"},
                                                                                     {"second", "away.team"},
                                                                                     {"first_wins", "home.wins"},
                                                                                     {"second_wins", "away.wins"}},
                                                                                    {}});
    EXPECT_NEAR(named(a.blocks.at(0).scales.at(0), "order effect p"), 0.0197, 0.002) << "Bradley-Terry: 0.0200";
}

} // namespace
} // namespace study::test
