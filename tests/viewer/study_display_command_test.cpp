// lightwell study calibrate, photodiode, and --display-model of check and plan: without a window.

#include "tests/viewer/run_program.h"

#include "study/journal/journal_file.h"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <random>

namespace viewer::test {
namespace {

std::string const kReadings =
    "channel,value,cd_m2\nwhite,0,0.2\nwhite,64,11.2\nwhite,128,44.0\nwhite,191,106\nwhite,255,200\n";
std::string const kSize =
    " --screen 1920x1080 --width-cm 53.1 --distance-cm 57.3 --monitor Test --date 2026-11-26 ";

void expect_refused_with(std::string const& arguments, TemporaryFolder const& folder, std::string const& message)
{
    Outcome const o = run(arguments, folder.path());
    EXPECT_EQ(o.code, 2) << arguments << "\n" << o.out;
    EXPECT_NE(o.err.find(message), std::string::npos) << arguments << "\n" << o.err;
}

TEST(StudyCalibrate, WritesAModelFromTypedReadings)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "r.csv") << kReadings;
    Outcome const o = run_well("study calibrate --luminance r.csv --ipd-mm 63 --instrument LS-150 --by me" +
                                   kSize + "--out m.yaml",
                               folder.path());
    EXPECT_NE(o.out.find("36.16 pixels per degree"), std::string::npos) << o.out;
    EXPECT_NE(o.err.find("only white was measured"), std::string::npos) << o.err;
    std::string const model = file_text(folder / "m.yaml");
    for (char const* part :
         {"date: \"2026-11-26\"", "instrument: \"LS-150\"", "by: \"me\"", "ipd_mm: 63", "size_cm: [53.1, "})
        EXPECT_NE(model.find(part), std::string::npos) << part << "\n" << model;
    run_well(
        "study calibrate --from m.yaml --distance-cm 114.6 --reading white:0=0.3 --reading white:0.5=40 --reading "
        "white:1=190 --out far.yaml",
        folder.path());
    EXPECT_NE(file_text(folder / "far.yaml").find("distance_cm: 114.6"), std::string::npos);
    EXPECT_NE(file_text(folder / "far.yaml").find("instrument: \"LS-150\""), std::string::npos) << "kept";
}

TEST(StudyCalibrate, RefusesWhatMakesNoModel)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "r.csv") << "channel,value,cd_m2\nwhite,0,0.2\nwhite,1,x\n";
    expect_refused_with("study calibrate --luminance r.csv --out m.yaml", folder,
                        "r.csv:3:1: 'x' is no luminance");
    expect_refused_with("study calibrate --out m.yaml", folder, "nothing was measured");
    expect_refused_with("study calibrate --distance-cm 57 --out m.yaml", folder, "without the size of the screen");
    expect_refused_with("study calibrate --width-cm 50 --out m.yaml", folder, "--screen 1920x1080");
    expect_refused_with("study calibrate --reading white=3 --out m.yaml", folder, "--reading white=3");
    expect_refused_with("study calibrate --measure purple --out m.yaml", folder, "'purple' is no colour");
    expect_refused_with("study calibrate --reading white:1=3 --primaries 1,2 --out m.yaml", folder, "six numbers");
    EXPECT_FALSE(std::filesystem::exists(folder / "m.yaml"));
}

std::string const kScript = R"(schema: study/1
id: deg
seed: 1
participants: {count: 1}
factors: {bounces: [0, 2]}
defaults: {settings: {method: slhb, scene: cornell, size: SIZE, peak_luminance: LUMINANCE}}
sequence: [seen]
blocks:
  seen: {task: rating, scale: {min: 1, max: 7}, cross: [bounces]}
)";

std::string script_of(std::string const& size, std::string const& luminance)
{
    std::string text = kScript;
    text.replace(text.find("SIZE"), 4, size);
    text.replace(text.find("LUMINANCE"), 9, luminance);
    return text;
}

TEST(StudyDisplayModel, IsCheckedAndPrinted)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "r.csv") << kReadings;
    run_well("study calibrate --luminance r.csv" + kSize + "--out m.yaml", folder.path());
    std::ofstream(folder / "s.yaml") << script_of("4 x 3 deg", "100 cd/m2");
    EXPECT_NE(run_well("study check s.yaml --display-model m.yaml", folder.path()).out.find("pixels per degree"),
              std::string::npos);
    EXPECT_NE(run_well("study plan s.yaml --display-model m.yaml", folder.path()).out.find("pixels per degree"),
              std::string::npos);
    auto const j =
        nlohmann::json::parse(run_well("study check s.yaml --display-model m.yaml --json", folder.path()).out);
    EXPECT_EQ(j["display_model"]["pixels_per_degree"], "36.161");
    std::ofstream(folder / "big.yaml") << script_of("60 deg", "100 cd/m2");
    expect_refused_with("study check big.yaml --display-model m.yaml", folder, "the screen has 1920 x 1080");
    std::ofstream(folder / "bright.yaml") << script_of("4 deg", "500 cd/m2");
    expect_refused_with("study check bright.yaml --display-model m.yaml", folder, "the display shows 0.2 to 19");
    expect_refused_with("study check s.yaml --display-model s.yaml", folder, "s.yaml:1:");
}

TEST(StudyPhotodiode, ComparesARecordingWithAJournal)
{
    TemporaryFolder const folder;
    run_well("study example rating --out rating.yaml", folder.path());
    run_well("study simulate rating.yaml --participants 1 --out records", folder.path());
    std::filesystem::path const beh = folder / "records/sub-P001/ses-01/beh";
    std::vector<std::pair<double, double>> shown;
    for (study::JournalEntry const& e : study::read_journal(beh / "journal.jsonl").record.entries)
        if (auto const* const t = std::get_if<study::TrialDone>(&e))
            for (study::StimulusShown const& s : t->shown)
                if (shown.empty() || shown.back().first != s.onset_s) // side by side: one onset
                    shown.emplace_back(s.onset_s, s.onset_s + s.duration_s);
    ASSERT_GT(shown.size(), 20u);
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::string csv = "t_s,light\n";
    std::size_t k = 0;
    std::vector<double> lag_s;
    for (std::size_t i = 0; i < shown.size(); ++i) lag_s.push_back(1e-3 * (9.5 + 0.4 * normal(random)));
    for (double t = shown[0].first - 1; t < shown.back().second + 1; t += 0.001) {
        while (k < shown.size() && shown[k].second + lag_s[k] < t) ++k;
        bool const is_lit = k < shown.size() && t >= shown[k].first + lag_s[k] && k != 4;
        csv += fmt::format("{:.4f},{:.3f}\n", t, (is_lit ? 3.1 : 0.4) + 0.05 * normal(random));
    }
    std::ofstream(folder / "diode.csv") << csv;
    std::string const call =
        "study photodiode diode.csv --session " + beh.string() + " --clock session --out lags.csv";
    Outcome const o = run(call + " --json", folder.path());
    EXPECT_EQ(o.code, 1) << "one is missing\n" << o.err;
    auto const j = nlohmann::json::parse(o.out);
    EXPECT_EQ(j["onsets"], shown.size());
    EXPECT_EQ(j["missed"], 1);
    EXPECT_EQ(j["extra"], 0);
    EXPECT_NEAR(j["methods"][0]["lag_mean_ms"].get<double>(), 9.5, 0.3);
    EXPECT_EQ(j["methods"][0]["onset_method"], "simulated");
    EXPECT_NE(run(call, folder.path()).out.find("display_lag_ms: 9."), std::string::npos);
    EXPECT_NE(file_text(folder / "lags.csv").find(",missed,NA,NA"), std::string::npos);
    expect_refused_with("study photodiode diode.csv --session " + beh.string() + " --part 9", folder,
                        "part 9 has no onset");
    expect_refused_with("study photodiode rating.yaml --session " + beh.string(), folder, "rating.yaml:");
    expect_refused_with("study photodiode diode.csv --session " + beh.string() + " --clock trigger", folder,
                        "no trigger channel");
}

} // namespace
} // namespace viewer::test
