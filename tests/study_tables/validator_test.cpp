// Our records against the validator of the standard (bids-validator-deno from PyPI, installed by scripts/setup
// --tests).

#include "study/script/examples.h"
#include "study/script/script_file.h"
#include "study/tables/bids.h"
#include "tests/study_tables/recorded.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace study::test {
namespace {

namespace fs = std::filesystem;

void write(fs::path const& file, std::string const& text)
{
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

/// Two participants of each shipped experiment, with all other files that a session leaves.
void write_dataset(fs::path const& folder, StudyExample const& example)
{
    fs::remove_all(folder);
    Script const s = parse_script(std::string(example.text), std::string(example.name));
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= 2; ++p) {
        sessions.push_back(record_session(s, p, [&](PlanStep const& step, TrialDone& done) {
            Block const& b = s.blocks[std::size_t(step.block)];
            if (b.task == Task::rating) done.value = b.scale.low;
            done.response = step.trial.answer.empty() && b.pairs ? "first" : step.trial.answer;
            if (b.compare && !done.level) done.level = b.compare->low;
        }));
        auto& entries = sessions.back().record.entries;
        entries.insert(entries.begin() + 2, ParticipantAsked{{{"age_band", "30-39"}, {"vision", "6/6"}}});
        entries.insert(entries.end() - 1, NoteTaken{90, "note", "tab\tand \"quotes\" and é"});
        for (TextFile const& f : session_files(s, sessions.back())) write(folder / f.path, f.text);
        fs::path const beh = folder / session_folder(start_of(s, sessions.back()));
        for (char const* name : {"journal.jsonl", "plan.tsv", "script.yaml", "sub-P001_ses-01_frames.csv",
                                 "sub-P001_ses-01_pose.csv.gz"})
            write(beh / name, "x\n");
    }
    for (TextFile const& f : dataset_files(s, sessions, "0.1.0")) write(folder / f.path, f.text);
}

TEST(Validator, OfBidsFindsNoErrorInTheRecordsOfAnyShippedExperiment)
{
    fs::path const validator = fs::path(LIGHTWELL_SOURCE_DIR) / "build" / "python" / "bin" / "bids-validator-deno";
    if (!fs::exists(validator))
        GTEST_SKIP()
            << "SKIPPED: bids-validator-deno is not installed (scripts/setup --tests installs it from PyPI)";
    for (StudyExample const& example : study_examples()) {
        fs::path const folder = fs::path(testing::TempDir()) / ("lightwell_bids_" + std::string(example.name));
        write_dataset(folder, example);
        fs::path const out = folder.string() + ".json";
        std::string const command = "'" + validator.string() + "' '" + folder.string() + "' --format json > '" +
                                    out.string() + "' 2>/dev/null";
        int const status = std::system(command.c_str());
        std::ifstream in(out);
        auto const found = nlohmann::json::parse(in, nullptr, false);
        ASSERT_FALSE(found.is_discarded()) << "the validator said nothing, status " << status;
        for (auto const& issue : found.at("issues").at("issues"))
            EXPECT_NE(issue.at("severity"), "error") << example.name << ": " << issue.dump();
        EXPECT_EQ(found.at("summary").at("subjects").size(), 2u);
        EXPECT_EQ(status, 0);
    }
}

} // namespace
} // namespace study::test
