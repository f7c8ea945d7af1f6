// The shipped experiment with model observers from end to end: what the analysis finds is what they were given.

#include "study/observers/simulate.h"
#include "study/report/page.h"
#include "study/script/script_file.h"
#include "study/tables/dataset.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

namespace study::test {
namespace {

namespace fs = std::filesystem;

std::string text_of(fs::path const& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

fs::path simulated(Script const& s, std::string const& script_text)
{
    fs::path const dir = fs::path(testing::TempDir()) / "lightwell_visibility2026";
    fs::remove_all(dir);
    std::string const file = LIGHTWELL_SOURCE_DIR "/data/observers/visibility2026.yaml";
    ObserverModel const model = read_observers(text_of(file), file, s);
    SessionSettings settings;
    settings.dir = dir;
    settings.script_text = script_text;
    settings.version = "test";
    keep_truth(dir, truth_text(s, model, s.seed));
    for (int p = 1; p <= s.participants.count; ++p)
        simulate_session(s, p, draw_observer(model, s.seed, p), settings, 0);
    return dir;
}

TEST(SimulatedVisibility, IsRankedAsItsObserversSawIt)
{
    fs::path const file = LIGHTWELL_SOURCE_DIR "/data/study/visibility2026.yaml";
    std::string const script_text = text_of(file);
    fs::path const dir = simulated(parse_script(script_text, file.string()), script_text);
    Dataset const d = read_dataset(dir, file);
    ASSERT_EQ(d.sessions.size(), 24u);
    AnalysisSettings settings; // scores and thresholds are looked at, not their intervals
    settings.replicates = 100;
    settings.draws = 0;
    Analysis const a = analyze(d.script, d.sessions, settings);
    SimulatedTruth const truth = read_truth(text_of(truth_file(dir)), "truth.json");

    ScaleResult const& pairs = a.blocks.at(0).scales.at(0);
    ASSERT_EQ(a.blocks[0].name, "similarity");
    ASSERT_EQ(pairs.refused, "");
    double mean = 0;
    for (ScaledItem const& i : pairs.items) mean += truth.quality_jod.at("visibility").at(i.name) / 5;
    for (ScaledItem const& i : pairs.items) {
        double const true_score = truth.quality_jod.at("visibility").at(i.name) - mean;
        EXPECT_NEAR(i.score.value, true_score, 0.25) << i.name;
        for (ScaledItem const& k : pairs.items)
            EXPECT_EQ(i.score.value > k.score.value, truth.quality_jod.at("visibility").at(k.name) <
                                                         truth.quality_jod.at("visibility").at(i.name))
                << i.name << " over " << k.name;
    }
    ScaleResult const& ratings = a.blocks.at(1).scales.at(0);
    auto const best = std::max_element(ratings.items.begin(), ratings.items.end(),
                                       [](auto const& x, auto const& y) { return x.score.value < y.score.value; });
    EXPECT_EQ(best->name, "exact");
    ASSERT_TRUE(ratings.cheapest);
    EXPECT_TRUE(ratings.cheapest->is_reference);

    for (CurveResult const& c : a.blocks.at(2).curves) {
        double const level = true_level(truth, "gi.points", true, 0.5, 0.75);
        EXPECT_LT(std::abs(std::log2(c.threshold.value / level)), 0.5) << c.cell;
    }
    std::string const page = report_page(d.script, d.sessions, a, {"test", truth, {}});
    EXPECT_NE(page.find("class=\"truth\""), std::string::npos);
}

} // namespace
} // namespace study::test
