// lightwell study rebuild, export, analyze, report: what they write and refuse.

#include "gi/core/sha256.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

/// Two simulated participants of the experiment `rating` in the folder `records`.
void simulate(TemporaryFolder const& folder)
{
    run_well("study example rating --out rating.yaml", folder.path());
    run_well("study simulate rating.yaml --participants 1..2 --out records", folder.path());
}

TEST(StudyRecords, AreRebuiltToTheSameBytes)
{
    TemporaryFolder const folder;
    simulate(folder);
    Outcome const first = run_well("study rebuild records --script rating.yaml", folder.path());
    EXPECT_NE(first.out.find("records: 2 sessions, "), std::string::npos) << first.out;
    EXPECT_EQ(file_text(folder / "records/code/rating.yaml"), file_text(folder / "rating.yaml"));
    auto const participants = file_text(folder / "records/participants.tsv");
    EXPECT_TRUE(participants.starts_with("participant_id\tnumber\tsessions\tcomplete\tsimulated")) << participants;
    std::map<std::string, std::string> before;
    for (auto const& e : std::filesystem::recursive_directory_iterator(folder / "records"))
        if (e.is_regular_file()) before[e.path().string()] = file_text(e.path());
    run_well("study rebuild records", folder.path()); // the script is found in code/
    for (auto const& [file, text] : before) EXPECT_EQ(file_text(file), text) << file;
}

TEST(StudyRecords, AreAnalysedExportedAndReported)
{
    TemporaryFolder const folder;
    simulate(folder);
    run_well("study rebuild records --script rating.yaml", folder.path());
    Outcome const text = run_well("study analyze records --replicates 100 --out numbers", folder.path());
    EXPECT_NE(text.out.find("2 of 2 sessions were answered by model observers"), std::string::npos) << text.out;
    auto const j = nlohmann::json::parse(run_well("study analyze records --json", folder.path()).out);
    EXPECT_EQ(j["participants"], 2);
    EXPECT_FALSE(j["tables"]["scores"].empty());
    ASSERT_EQ(j["inputs"].size(), 3u) << "script and two journals";
    EXPECT_EQ(j["inputs"][0]["sha256"], gi::sha256(file_text(folder / "rating.yaml")));
    EXPECT_TRUE(j["tables"]["scores"][0]["score"].is_number());
    EXPECT_TRUE(std::filesystem::exists(folder / "numbers/scores.csv"));
    EXPECT_TRUE(nlohmann::json::accept(file_text(folder / "numbers/analysis.json")));
    run_well("study export records --out exported --sqlite records.sqlite", folder.path());
    EXPECT_TRUE(file_text(folder / "records.sqlite").starts_with("SQLite format 3"));
    EXPECT_TRUE(file_text(folder / "exported/analysis.R").find("lmer") != std::string::npos);
    std::ofstream(folder / "records/sub-P001/ses-01/beh/x_frames.csv")
        << "step,attempt,shown,t_swap_s,uncertainty_ms\n1,1,0,10.000,0\n1,1,0,10.016,0\n1,1,0,10.033,0\n1,1,1,11,"
           "0\n"
           "1,1,1,11.016,0\n1,1,";
    run_well("study report records --out report.html", folder.path());
    EXPECT_NE(file_text(folder / "report.html").find("<b>Intervals between frames</b> 3 values"),
              std::string::npos);
    EXPECT_TRUE(file_text(folder / "report.html").starts_with("<!DOCTYPE html>"));
}

void expect_refused(std::string const& arguments, TemporaryFolder const& folder, std::string const& message)
{
    Outcome const o = run(arguments, folder.path());
    EXPECT_EQ(o.code, 2) << arguments;
    EXPECT_NE(o.err.find(message), std::string::npos) << o.err;
}

TEST(StudyRecords, ThatAreNotThereOrOfAnotherScriptAreRefused)
{
    TemporaryFolder const folder;
    expect_refused("study analyze nowhere", folder, "no session is there");
    simulate(folder);
    std::filesystem::remove_all(folder / "records/code"); // which a session's end keeps
    expect_refused("study analyze records", folder, "the script of the sessions is not there");
    run_well("study example pairs --out pairs.yaml", folder.path());
    expect_refused("study analyze records --script pairs.yaml", folder, "recorded with another script");
    expect_refused("study analyze records --script rating.yaml --exclude P099", folder,
                   "'P099' is to be excluded");
    expect_refused("study export records --script rating.yaml", folder, "nothing to export to");
    expect_refused("study report records --script rating.yaml --out no/where.html", folder, "no");
    EXPECT_FALSE(std::filesystem::exists(folder / "records/code")) << "reading changes nothing";
}

TEST(StudyTables, OfOthersAreAnalysedAndReportedLikeRecords)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "1.csv") << "who,a,b,best,age\n1,x,y,x,old\n1,x,z,z,old\n1,y,z,z,old\n1,x,y,,old\n";
    std::ofstream(folder / "2.csv") << "who,a,b,best,age\n2,x,y,y,young\n2,x,z,x,young\n2,y,z,z,young\n"
                                       "3,x,y,x,young\n3,z,y,z,young\n3,z,x,x,young\n";
    std::string const table =
        "--table 1.csv 2.csv --columns participant=who,first=a,second=b,chosen=best --factors age";
    Outcome const printed = run_well("study analyze " + table + " --json --replicates 100", folder.path());
    auto const j = nlohmann::json::parse(printed.out);
    EXPECT_EQ(j["participants"], 3);
    EXPECT_EQ(j["tables"]["scores"].size(), 9u) << "three items, all and two groups";
    EXPECT_NE(printed.err.find("1 of 10 rows left out: no 'best'"), std::string::npos) << printed.err;
    EXPECT_EQ(j["cautions"][0], "1 of 10 rows left out: no 'best'");
    run_well("study analyze " + table + " --out numbers --draws 0 --replicates 100", folder.path());
    EXPECT_NE(file_text(folder / "numbers" / "cautions.csv").find("1 of 10 rows left out"), std::string::npos);
    run_well("study report " + table + " --out report.html --replicates 100", folder.path());
    EXPECT_NE(file_text(folder / "report.html").find("<svg"), std::string::npos);
    expect_refused("study analyze", folder, "no records");
    expect_refused("study analyze --table 1.csv", folder, "--table without --columns");
    expect_refused("study analyze --table 1.csv --columns participant=who,first=a,second=b,chosen=c", folder,
                   "1.csv:1:1: there is no column 'c'");
    expect_refused("study analyze --table 1.csv --columns who=who", folder, "there is no such role");
    expect_refused("study analyze --table 1.csv --columns participant=who --guess 0.6 --lapse 0.4", folder,
                   "no room for a psychometric function");
    expect_refused("study analyze --table no.csv --columns item=a,value=b", folder, "no.csv");
    expect_refused("study analyze " + table + " --only age", folder, "--only 'age'");
}

TEST(StudyTables, TellWhatTheyWereComputedFromAndHowIdsWereTaken)
{
    TemporaryFolder const folder;
    auto const write = [&](char const* name, int shift) {
        std::ofstream file(folder / name);
        file << "id,i,v\n";
        for (int p = 1; p <= 4; ++p)
            for (int i = 0; i < 3; ++i)
                file << p << ","
                     << "ABC"[i] << "," << (p == 2 && i == 1 ? -99 : 2 + (p + i * shift) % 5) << "\n";
    };
    write("young.csv", 1);
    write("old.csv", 3);
    std::string const roles = " --draws 0 --replicates 100 --columns item=i,value=v,participant=";
    auto const j = nlohmann::json::parse(
        run_well("study analyze --json --table young.csv old.csv --factors file --missing -99" + roles + "file+id",
                 folder.path())
            .out);
    EXPECT_EQ(j["experiment"], "young and old");
    EXPECT_EQ(j["participants"], 8);
    EXPECT_EQ(j["cautions"][0], "2 of 24 rows left out: 'v' is -99");
    EXPECT_EQ(j["tables"]["factors"][0]["factor"], "file");
    EXPECT_EQ(j["tables"]["factors"][0]["taken_as"], "between participants");
    EXPECT_EQ(j["tables"]["factors"][1]["taken_as"], "within participants");
    EXPECT_FALSE(j["version"].get<std::string>().empty() || j["git"].get<std::string>().empty());
    ASSERT_EQ(j["inputs"].size(), 2u);
    EXPECT_EQ(j["inputs"][1]["file"], "old.csv");
    EXPECT_EQ(j["inputs"][1]["sha256"], gi::sha256(file_text(folder / "old.csv")));
    Outcome const text = run_well("study analyze --table young.csv old.csv" + roles + "id", folder.path());
    EXPECT_NE(text.out.find("are in several files"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("-99 2 times in column 'v' is far from all others"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("within participants"), std::string::npos) << text.out;
    std::filesystem::copy_file(folder / "young.csv", folder / "copy.csv");
    expect_refused("study analyze --table young.csv copy.csv" + roles + "id", folder,
                   "copy.csv: the file has the same rows as 'young.csv'");
    expect_refused("study analyze --table young.csv --missing id=" + roles + "id", folder, "--missing 'id='");
}

TEST(StudyPower, PrintsPowerAndWritesACurve)
{
    TemporaryFolder const folder;
    run_well("study example pairs --out pairs.yaml", folder.path());
    Outcome const o =
        run_well("study power pairs.yaml --block better --test none-wide --participants 6,12 --effects "
                 "0,1 --simulations 10 --out power",
                 folder.path());
    EXPECT_NE(o.out.find("10 of 10 simulations"), std::string::npos) << o.out;
    EXPECT_EQ(nlohmann::json::parse(file_text(folder / "power/power.json"))["points"].size(), 4u);
    EXPECT_TRUE(file_text(folder / "power/power.csv").starts_with("repeats,participants,effect,power"));
    EXPECT_NE(file_text(folder / "power/power.html").find("<svg"), std::string::npos);
    expect_refused("study power pairs.yaml --block better --test none-best", folder, "it has: ");
    expect_refused("study power pairs.yaml --block worse --test none-wide", folder, "it has: better");
    expect_refused("study power pairs.yaml --block better --test none-wide --effect-of sound", folder,
                   "the script has no such factor");
}

} // namespace
} // namespace viewer::test
