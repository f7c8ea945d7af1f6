// lightwell study: what it prints, writes and refuses.

#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

TEST(StudyCommand, ChecksEveryShippedExample)
{
    TemporaryFolder const folder;
    run_well("ar synthesize desk --frames 12 --size 64x48 --paths 1 --no-denoise", folder.path()); // of ar_paths
    for (auto const& entry : std::filesystem::directory_iterator(LIGHTWELL_SOURCE_DIR "/data/study")) {
        std::string const name = entry.path().stem().string(), file = name + ".yaml";
        run_well("study example " + name + " --out " + file, folder.path());
        EXPECT_EQ(file_text(folder / file), file_text(entry.path()));
        Outcome const o = run_well("study check " + file, folder.path());
        EXPECT_NE(o.out.find("plans made, the longest is expected to take"), std::string::npos) << o.out;
        EXPECT_TRUE(o.err.empty()) << o.err;
    }
}

TEST(StudyCommand, PlansAParticipant)
{
    TemporaryFolder const folder;
    run_well("study example visibility2026 --out v.yaml", folder.path());
    Outcome const o = run_well("study plan v.yaml --participant 3 --out plan.tsv", folder.path());
    for (char const* part : {"visibility2026: participant 3 of 24 (P003), seed 20261", "questionnaire ssq",
                             "display hmd", "trials: practice, main, catch", "from one trial to the next",
                             "% of neighbours differ, by chance", "expected duration 4"})
        EXPECT_NE(o.out.find(part), std::string::npos) << part;
    std::string const table = file_text(folder / "plan.tsv");
    EXPECT_TRUE(
        table.starts_with("step\tkind\tblock\tpass\ttrial\tphase\ttask\trepeat\tscene\tvisibility\tdisplay\t"));
    run_well("study plan v.yaml --participant 3 --out again.tsv", folder.path());
    EXPECT_EQ(file_text(folder / "again.tsv"), table);
    run_well("study plan v.yaml --participant 4 --out other.tsv", folder.path());
    EXPECT_NE(file_text(folder / "other.tsv"), table);
    auto const j = nlohmann::json::parse(run_well("study plan v.yaml --json", folder.path()).out);
    int trials = 0;
    for (auto const& block : j["blocks"]) trials += block["main"].get<int>();
    EXPECT_EQ(trials, 206);
    EXPECT_FALSE(j["transitions"].empty());
    auto const check = nlohmann::json::parse(run_well("study check v.yaml --json", folder.path()).out);
    EXPECT_EQ(check["plans_made"], 24);
    EXPECT_EQ(check["full_cycle"], 12);
}

TEST(StudyCommand, WarnsOfLongSessions)
{
    TemporaryFolder const folder;
    std::string text = file_text(LIGHTWELL_SOURCE_DIR "/data/study/visibility2026.yaml");
    text.replace(text.find("stimulus_ms: 6000"), 17, "stimulus_ms: 30000");
    std::ofstream(folder / "long.yaml") << text;
    for (char const* command : {"study plan long.yaml", "study check long.yaml"}) {
        Outcome const o = run_well(command, folder.path());
        EXPECT_NE(o.err.find("people tire after about 60 minutes"), std::string::npos) << o.err;
    }
}

TEST(StudyCommand, RefusesInOneLine)
{
    TemporaryFolder const folder;
    run_well("study example rating --out r.yaml", folder.path());
    std::string text = file_text(folder / "r.yaml");
    std::ofstream(folder / "key.yaml") << text << "recrod: {dir: data}\n";
    text.replace(text.find("  - tasks\n"), 10, "  - {instructions: nowhere.md}\n  - tasks\n");
    std::ofstream(folder / "file.yaml") << text;
    for (auto const& [arguments, mentions] :
         {std::pair{"study", "subcommand"},
          {"study check nowhere.yaml", "nowhere.yaml"},
          {"study check key.yaml", "key.yaml:"},
          {"study check key.yaml", "unknown key 'recrod' in script (it would be ignored) did you mean 'record'?"},
          {"study check file.yaml", "there is no file 'nowhere.md'"},
          {"study plan r.yaml --participant 13", "participant 13 of 12"},
          {"study plan r.yaml --participant 0", "participant"},
          {"study plan r.yaml --out r.yaml", "it is also an input"},
          {"study plan r.yaml --out nowhere/plan.tsv", "there is no folder"},
          {"study example nothing --out x",
           "there are: active, ar_paths, brightness, pairs, rating, sensitivity, sounds, staircase, visibility2026"}}) {
        Outcome const o = run(arguments, folder.path());
        EXPECT_EQ(o.code, 2) << arguments;
        EXPECT_NE(o.err.find(mentions), std::string::npos) << arguments << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"file.yaml", "key.yaml", "r.yaml"}));
}

} // namespace
} // namespace viewer::test
