// lightwell study simulate: what it prints, writes and refuses.

#include "tests/support/processor_time.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

TEST(StudySimulate, RunsAllParticipantsOfAnExperimentInSeconds)
{
    TemporaryFolder const folder;
    run_well("study example visibility2026 --out v.yaml", folder.path());
    double const start_s = gi::test::processor_s();
    Outcome const o = run_well("study simulate v.yaml --observer " LIGHTWELL_SOURCE_DIR
                               "/data/observers/visibility2026.yaml --out d",
                               folder.path());
    EXPECT_LT(gi::test::processor_s() - start_s, 100);
    EXPECT_EQ(std::count(o.out.begin(), o.out.end(), '\n'), 24);
    for (int p = 1; p <= 24; ++p) {
        char name[32];
        std::snprintf(name, sizeof name, "d/sub-P%03d/ses-01/beh", p);
        EXPECT_EQ(nlohmann::json::parse(file_text(folder / name / "session.json")).at("complete"), true);
        EXPECT_TRUE(std::filesystem::exists(folder / name / "plan.tsv"));
    }
    auto const truth = nlohmann::json::parse(file_text(folder / "d/sourcedata/simulation/truth.json"));
    EXPECT_EQ(truth.at("quality_jod").at("visibility").at("none"), -2.6);
    EXPECT_EQ(truth.at("participants").size(), 24u);
}

TEST(StudySimulate, SaysWhatItDidAsJsonAndLineByLine)
{
    TemporaryFolder const folder;
    run_well("study example rating --out r.yaml", folder.path());
    auto const j =
        nlohmann::json::parse(run_well("study simulate r.yaml --participants 2,4..5 --json", folder.path()).out);
    ASSERT_EQ(j.at("sessions").size(), 3u);
    EXPECT_EQ(j.at("sessions")[1].at("participant_id"), "P004");
    EXPECT_EQ(j.at("sessions")[1].at("complete"), true);
    Outcome const o = run_well("study simulate r.yaml --participants 1 --each --session 2", folder.path());
    EXPECT_TRUE(o.out.starts_with("P001 step 1 attempt 1: confirm\n")) << o.out;
    EXPECT_NE(o.out.find("P001 step 28\n"), std::string::npos) << "what is no trial has no answer";
    EXPECT_TRUE(std::filesystem::exists(folder / "simulated-rating/sub-P001/ses-02/beh/journal.jsonl"));
}

TEST(StudySimulate, GoesOnAndRepeatsPracticeAfterALongGap)
{
    TemporaryFolder const folder;
    run_well("study example visibility2026 --out v.yaml", folder.path());
    run_well("study simulate v.yaml --participants 1 --out d", folder.path());
    auto const journal = folder / "d/sub-P001/ses-01/beh/journal.jsonl";
    std::string const text = file_text(journal);
    // Cut within a line, after practice and some trials of the first block.
    std::size_t at = 0;
    for (int line = 0; line < 20; ++line) at = text.find('\n', at) + 1;
    std::ofstream(journal, std::ios::binary) << text.substr(0, at + 100);
    Outcome const o =
        run_well("study simulate v.yaml --participants 1 --out d --resume --gap-min 90 --each", folder.path());
    EXPECT_NE(o.err.find("P001: 100 bytes of an incomplete line were removed"), std::string::npos) << o.err;
    EXPECT_NE(o.out.find("attempt 2"), std::string::npos) << "practice again";
    std::istringstream lines(file_text(journal));
    std::string kinds;
    for (std::string line; std::getline(lines, line);)
        kinds += nlohmann::json::parse(line).at("kind").get<std::string>() + "\n";
    EXPECT_NE(kinds.find("session_ended"), std::string::npos);
    Outcome const again = run_well("study simulate v.yaml --participants 1 --out d --resume", folder.path());
    EXPECT_TRUE(again.out.starts_with("P001: 0 trials, 0 bad, complete")) << again.out;
}

TEST(StudySimulate, RefusesInOneLine)
{
    TemporaryFolder const folder;
    run_well("study example rating --out r.yaml", folder.path());
    run_well("study simulate r.yaml --participants 1 --out d", folder.path());
    std::ofstream(folder / "o.yaml") << "lapse: 0.1\nnoize: 2\n";
    std::ofstream(folder / "shaky.yaml") << "display: {period_sd_ms: 5}\n";
    std::string strict = file_text(folder / "r.yaml");
    strict =
        strict.substr(0, strict.find("timing:")) + strict.substr(strict.find('\n', strict.find("timing:")) + 1);
    std::ofstream(folder / "strict.yaml") << strict;
    std::ofstream(folder / "file") << "x";
    for (auto const& [arguments, mentions] :
         {std::pair{"study simulate r.yaml --participants 1 --out d", "participant P001 has a session 1 already"},
          {"study simulate r.yaml --participants 1,2 --out d", "start another one with --session 2"},
          {"study simulate r.yaml --participants 2 --out d --seed 1", "other observers answered in this folder"},
          {"study simulate r.yaml --participants 99", "'99' is not one of 1 to 12"},
          {"study simulate r.yaml --participants 3..1", "write 3, 1..24"},
          {"study simulate r.yaml --participants x", "'x' is not one of"},
          {"study simulate r.yaml --session 100", "--session"},
          {"study simulate r.yaml --gap-min 3", "--resume"},
          {"study simulate r.yaml --observer o.yaml", "o.yaml:2:1: unknown key 'noize'"},
          {"study simulate r.yaml --observer none.yaml", "none.yaml"},
          {"study simulate strict.yaml --observer shaky.yaml --out e", "the display does not pass the test"},
          {"study simulate r.yaml --out file", "the folder cannot be made (Not a directory)"}}) {
        Outcome const o = run(arguments, folder.path());
        EXPECT_EQ(o.code, 2) << arguments << o.out;
        EXPECT_NE(o.err.find(mentions), std::string::npos) << arguments << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "d/sub-P002"));
}

} // namespace
} // namespace viewer::test
