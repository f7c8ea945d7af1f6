// Our records against the validators of the standards: of BIDS (bids-validator-deno) and of HED (hedtools), both
// from PyPI, installed by scripts/setup --tests.

#include "study/script/examples.h"
#include "study/script/script_file.h"
#include "study/tables/bids.h"
#include "tests/study_tables/recorded.h"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>
#include <zlib.h>

namespace study::test {
namespace {

namespace fs = std::filesystem;

void write(fs::path const& file, std::string const& text)
{
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

void write_gzip(fs::path const& file, std::string const& text)
{
    fs::create_directories(file.parent_path());
    gzFile const out = gzopen(file.c_str(), "wb");
    ASSERT_EQ(gzwrite(out, text.data(), unsigned(text.size())), int(text.size()));
    gzclose(out);
}

/// Participants of a shipped experiment, with all other files that a session leaves.
void write_dataset(fs::path const& folder, StudyExample const& example, int participants)
{
    fs::remove_all(folder);
    Script const s = parse_script(std::string(example.text), std::string(example.name));
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= participants; ++p) {
        sessions.push_back(record_session(s, p, [&](PlanStep const& step, TrialDone& done) {
            Block const& b = s.blocks[std::size_t(step.block)];
            if (b.task == Task::rating) done.value = b.scale.low;
            done.response = step.trial.answer.empty() && b.pairs ? "first" : step.trial.answer;
            if (b.compare && !done.level) done.level = b.compare->low;
            for (StimulusShown& shown : done.shown) {
                shown.mean_cd_m2 = 20;
                shown.peak_cd_m2 = 80;
                shown.clipped_pixels = 3;
                shown.width_deg = shown.height_deg = 4;
                shown.frames_kind = "shown";
                shown.frames_drawn = 110;
                shown.light_age_ms = 80;
            }
            if (!b.is_sequential) // they appear together
                for (StimulusShown& shown : done.shown) shown.onset_s = done.shown[0].onset_s;
            for (Cue const& c : b.cues) // one was not played
                done.sounds.push_back(
                    {s.sounds[std::size_t(c.sound)].name, "a", done.shown.at(0).onset_s, c.offset_ms,
                     c.offset_ms < 0 ? std::optional<double>() : done.shown.at(0).onset_s + 0.001, 0.05, 0,
                     c.offset_ms < 0 ? "device failed" : ""});
            done.gaze_samples = 250;
            done.gaze_valid = 240;
            done.gaze_dropped = 1;
        }));
        auto& all = sessions.back().record.entries;
        all.insert(all.begin() + 2, CalibrationDone{600, 60, 16.7, 0.1, "swap_finish", true, ""}); // as resumed
        for (JournalEntry& entry : all) // two trials that never began: rows without an onset
            if (auto* const t = std::get_if<TrialDone>(&entry); t != nullptr && t->step % 9 == 4) {
                t->shown.clear();
                t->is_valid = false;
                t->reason = "no_fixation";
            }
        auto& started = std::get<SessionStarted>(sessions.back().record.entries.front());
        for (auto const& [key, value] : {std::pair{"os", "Linux"},
                                         {"screen_px", "1920 x 1080"},
                                         {"screen_cm", "53.10 x 29.87"},
                                         {"viewing_distance_cm", "57"},
                                         {"refresh_hz", "60"},
                                         {"pixels_per_degree", "36.2"}})
            started.about.emplace_back(key, value);
        std::string const gaze = gaze_stem(s, sessions.back());
        TextFile const sidecar = gaze_sidecar(s, sessions.back(), 250, 1.5);
        write(folder / sidecar.path, sidecar.text);
        write_gzip(folder / (gaze + ".tsv.gz"), "1.5\t640\t360\t3.1\t2\n1.504\tn/a\tn/a\tn/a\tn/a\n");
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
    // One data set and the others below it: the validator starts slowly. Deno reads nothing in /dev, where TempDir()
    // may be.
    fs::path const root = "/tmp/lightwell_bids_" + std::to_string(getpid());
    std::size_t below = 0;
    for (StudyExample const& example : study_examples()) {
        bool const is_first = &example == &study_examples().front();
        fs::path const folder = is_first ? root : root / "derivatives" / std::string(example.name);
        write_dataset(folder, example, 2);
        below += !is_first;
        if (!is_first) // .bidsignore holds for the first alone
            for (fs::directory_entry const& file : fs::recursive_directory_iterator(folder))
                for (char const* ignored :
                     {"journal.jsonl", "plan.tsv", "script.yaml", "session.json", "_frames.csv", "_pose.csv.gz"})
                    if (file.path().filename().string().ends_with(ignored)) fs::remove(file.path());
    }
    fs::path const out = root.string() + ".json";
    int const status = std::system(fmt::format("'{}' '{}' --recursive --format json > '{}' 2>/dev/null",
                                               validator.string(), root.string(), out.string())
                                       .c_str());
    auto const all = nlohmann::json::parse(std::ifstream(out), nullptr, false);
    fs::remove_all(root);
    fs::remove(out);
    ASSERT_FALSE(all.is_discarded()) << "the validator said nothing, status " << status;
    auto const expect_right = [](nlohmann::json const& found, std::string const& name) {
        for (auto const& issue : found.at("issues").at("issues"))
            EXPECT_NE(issue.at("severity"), "error") << name << ": " << issue.dump();
        EXPECT_EQ(found.at("summary").at("subjects").size(), 2u) << name;
    };
    expect_right(all, "the first");
    EXPECT_EQ(all.at("derivativesSummary").size(), below);
    for (auto const& [name, found] : all.at("derivativesSummary").items()) expect_right(found, name);
    EXPECT_EQ(status, 0);
}

TEST(Validator, OfHedFindsNoErrorInTheTagsOfAnyShippedExperiment)
{
    fs::path const python = fs::path(LIGHTWELL_SOURCE_DIR) / "build/python/bin/python";
    if (std::system(("'" + python.string() + "' -c 'import hed' 2> /dev/null").c_str()) != 0)
        GTEST_SKIP() << "SKIPPED: hedtools is not installed (scripts/setup --tests installs it from PyPI)";
    std::string folders;
    for (StudyExample const& example : study_examples()) {
        fs::path const folder = fs::path(testing::TempDir()) / ("lightwell_hed_" + std::string(example.name));
        write_dataset(folder, example, 1);
        folders += " '" + folder.string() + "'";
    }
    fs::path const out = fs::path(testing::TempDir()) / "lightwell_hed.txt";
    int const status =
        std::system(("'" + python.string() + "' -O '" LIGHTWELL_SOURCE_DIR "/tests/study_tables/validate_hed.py'" +
                     folders + " > '" + out.string() + "' 2>&1")
                        .c_str());
    std::ifstream in(out);
    std::string const said{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(status, 0) << said;
    EXPECT_NE(said.find("0 errors"), std::string::npos) << said;
    std::cout << said;
}

} // namespace
} // namespace study::test
