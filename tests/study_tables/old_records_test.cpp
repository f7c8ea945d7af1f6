// Sessions that earlier versions recorded, and sessions whose plan this version would make otherwise: tables,
// analysis, report and resuming work with the recorded plan, and what differs is said.
// tests/data/old/COMMIT/study was written by `study simulate` of that commit; of its second session only the first
// entries are left, as after a kill.

#include "gi/core/durable_file.h"
#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "study/analysis/analysis.h"
#include "study/analysis/result_tables.h"
#include "study/journal/entry_line.h"
#include "study/journal/journal_file.h"
#include "study/journal/journal_folders.h"
#include "study/observers/simulate.h"
#include "study/report/page.h"
#include "study/script/script_file.h"
#include "study/tables/bids.h"
#include "study/tables/dataset.h"
#include "study/tables/export.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace study::test {
namespace {

namespace fs = std::filesystem;
using viewer::test::file_text;
using viewer::test::TemporaryFolder;

fs::path const kOld = fs::path(LIGHTWELL_SOURCE_DIR) / "tests/data/old";

std::string replaced(std::string text, std::string const& from, std::string const& to)
{
    std::size_t const at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::string csv_of_all(Dataset const& d)
{
    std::string all;
    for (NamedTable const& t : export_tables(d.script, d.sessions)) all += t.name + "\n" + csv_text(t.table, "NA");
    return all;
}

/// Records of one commit, in a folder that a test may change.
class OldRecords : public testing::TestWithParam<char const*> {
protected:
    OldRecords()
    {
        fs::copy(kOld / GetParam() / "study", dir.path(), fs::copy_options::recursive);
        gi::make_folder(dir / "code");
        fs::copy_file(kOld / "kept.yaml", dir / "code/kept.yaml");
        script_text = file_text(dir / "code/kept.yaml");
    }

    Dataset read() const { return read_dataset(dir.path(), {}); }
    Script script() const { return parse_script(script_text, "kept.yaml"); }
    fs::path folder(std::string const& id) const { return session_folder(dir.path(), id, 1); }

    /// As if this version made other plans: it makes those of another seed, while the recorded ones stay.
    void change_plans_of_this_version()
    {
        script_text = replaced(script_text, "seed: 41", "seed: 42");
        gi::write_durably(dir / "code/kept.yaml", script_text);
        for (std::string const id : {"P001", "P002"}) {
            auto entries = read_journal(folder(id) / "journal.jsonl").record.entries;
            auto& start = std::get<SessionStarted>(entries.front());
            start.script_sha256 = gi::sha256(script_text);
            start.seed = 42;
            std::string text;
            int number = 0;
            for (JournalEntry const& e : entries) text += entry_line(e, ++number) + "\n";
            gi::write_durably(folder(id) / "journal.jsonl", text);
        }
    }

    SessionOutcome go_on() const
    {
        Script const s = script();
        SessionSettings settings;
        settings.dir = dir.path();
        settings.script_folder = dir.path();
        settings.script_text = script_text;
        settings.start = SessionStart::go_on;
        settings.version = "0.2.0";
        return simulate_session(s, 2, draw_observer(usual_observers(s), 7, 2), settings, 60);
    }

    TemporaryFolder dir;
    std::string script_text;
};

int trials_in(SessionRecord const& record)
{
    return int(std::ranges::count_if(record.entries, [](JournalEntry const& e) {
        auto const* const trial = std::get_if<TrialDone>(&e);
        return trial != nullptr && trial->is_valid;
    }));
}

TEST_P(OldRecords, BecomeTables)
{
    Dataset const d = read();
    ASSERT_EQ(d.sessions.size(), 2u);
    EXPECT_TRUE(is_complete(d.sessions[0]));
    EXPECT_FALSE(is_complete(d.sessions[1]));
    for (RecordedSession const& session : d.sessions) {
        EXPECT_EQ(session.plan_source, PlanSource::same);
        EXPECT_EQ(contradiction(d.script, session.plan, session.record), "");
        EXPECT_GT(session_files(d.script, session).size(), 4u);
    }
    EXPECT_TRUE(d.remarks.empty()) << d.remarks.front();
    auto const tables = export_tables(d.script, d.sessions);
    std::size_t done = 0;
    for (RecordedSession const& session : d.sessions) done += trial_rows(d.script, session).size();
    EXPECT_EQ(tables.at(0).table.rows.size(), done);
    EXPECT_GT(done, 30u);
}

TEST_P(OldRecords, AreAnalysedAndReported)
{
    Dataset const d = read();
    Analysis const a = analyze(d, {.replicates = 100, .draws = 0});
    EXPECT_EQ(a.sessions, 2);
    EXPECT_EQ(a.blocks.size(), 3u);
    EXPECT_EQ(a.other_plans + a.assumed_plans, 0);
    EXPECT_NE(report_page(d.script, d.sessions, a, {}).find("Kept for later versions"), std::string::npos);
}

TEST_P(OldRecords, UnfinishedSessionsGoOn)
{
    int const before = trials_in(read().sessions[1].record);
    SessionOutcome const o = go_on();
    EXPECT_TRUE(o.is_complete) << o.reason;
    EXPECT_EQ(o.plan_remark, "");
    Dataset const d = read();
    EXPECT_TRUE(is_complete(d.sessions[1]));
    EXPECT_EQ(trials_in(d.sessions[1].record), before + o.trials);
    EXPECT_EQ(contradiction(d.script, d.sessions[1].plan, d.sessions[1].record), "");
}

TEST_P(OldRecords, TablesAreThoseOfTheRecordedPlan)
{
    std::string const before = csv_of_all(read());
    change_plans_of_this_version();
    Dataset const d = read();
    ASSERT_EQ(d.remarks.size(), 1u);
    EXPECT_NE(d.remarks[0].find("plans of 2 of 2 sessions; sub-P001/ses-01: this version makes another plan than "
                                "version 0.1.0, the recorded one is used: "),
              std::string::npos)
        << d.remarks[0];
    EXPECT_NE(d.remarks[0].find(" steps differ, the first is step "), std::string::npos) << d.remarks[0];
    for (RecordedSession const& session : d.sessions) EXPECT_EQ(session.plan_source, PlanSource::recorded);
    EXPECT_NE(plan_table(d.script, make_plan(d.script, 1)), file_text(folder("P001") / "plan.tsv"));
    EXPECT_EQ(csv_of_all(d), before);
}

TEST_P(OldRecords, AnalysisOfTheRecordedPlanSaysSo)
{
    AnalysisSettings const settings{.replicates = 100, .draws = 0};
    auto const before = nlohmann::json::parse(to_json(analyze(read(), settings)));
    change_plans_of_this_version();
    Dataset const d = read();
    Analysis const a = analyze(d, settings);
    auto const now = nlohmann::json::parse(to_json(a));
    EXPECT_EQ(now.at("tables"), before.at("tables"));
    EXPECT_EQ(before.at("sessions_with_another_plan"), 0);
    EXPECT_EQ(now.at("sessions_with_another_plan"), 2);
    EXPECT_EQ(now.at("cautions").at(0), d.remarks.at(0));
    EXPECT_NE(report_page(d.script, d.sessions, a, {}).find("the recorded one is used"), std::string::npos);
}

TEST_P(OldRecords, ResumedSessionsFollowTheRecordedPlan)
{
    change_plans_of_this_version();
    SessionOutcome const o = go_on();
    EXPECT_TRUE(o.is_complete) << o.reason;
    EXPECT_NE(o.plan_remark.find("this version makes another plan"), std::string::npos) << o.plan_remark;
    Dataset const d = read();
    SessionRecord const& record = d.sessions[1].record;
    EXPECT_EQ(d.sessions[1].plan_source, PlanSource::recorded);
    EXPECT_EQ(contradiction(d.script, d.sessions[1].plan, record), "");
    EXPECT_NE(contradiction(d.script, make_plan(d.script, 2), record), "");
    int warnings = 0;
    std::vector<std::string> plans;
    for (JournalEntry const& e : record.entries) {
        auto const* const note = std::get_if<NoteTaken>(&e);
        warnings += note && note->kind == "warning" && note->text == o.plan_remark;
        if (auto const* const start = std::get_if<SessionStarted>(&e)) plans.push_back(start->plan_sha256);
    }
    EXPECT_EQ(warnings, 1);
    EXPECT_EQ(plans, std::vector<std::string>(2, gi::sha256(file_text(folder("P002") / "plan.tsv"))));
}

TEST_P(OldRecords, LostPlanIsMadeAgainWhereItsHashIsThatOfTheJournal)
{
    std::string const before = csv_of_all(read());
    fs::remove(folder("P001") / "plan.tsv");
    EXPECT_TRUE(read().remarks.empty());
    gi::write_durably(folder("P001") / "plan.tsv", "step\n");
    Dataset const d = read();
    ASSERT_EQ(d.remarks.size(), 1u);
    EXPECT_NE(d.remarks[0].find("plan.tsv was changed after the session began; the plan that the journal names"),
              std::string::npos)
        << d.remarks[0];
    EXPECT_EQ(csv_of_all(d), before);
}

TEST_P(OldRecords, ChangedPlanIsUsedWhereTheJournalDoesNotContradictIt)
{
    std::string const before = csv_of_all(read());
    change_plans_of_this_version();
    std::string windows;
    std::istringstream in(file_text(folder("P001") / "plan.tsv"));
    for (std::string line; std::getline(in, line);) windows += line + "\r\n";
    gi::write_durably(folder("P001") / "plan.tsv", windows);
    Dataset const d = read();
    EXPECT_EQ(d.sessions[0].plan_source, PlanSource::assumed);
    EXPECT_EQ(d.remarks.size(), 2u);
    EXPECT_EQ(csv_of_all(d), before);
    EXPECT_EQ(analyze(d, {.replicates = 100, .draws = 0}).assumed_plans, 1);
}

TEST_P(OldRecords, LostPlanIsRefusedWithTheWayOutWhereNoneFits)
{
    change_plans_of_this_version();
    fs::remove(folder("P001") / "plan.tsv");
    try {
        read();
        FAIL() << "it was read";
    } catch (ScriptError const& e) {
        std::string const what = e.what();
        EXPECT_NE(
            what.find("the plan of this session is lost (plan.tsv is missing, and the journal contradicts the "
                      "plan that this version makes: "),
            std::string::npos)
            << what;
        EXPECT_NE(what.find("restore the file from a copy, or write it by version 0.1.0 (git "), std::string::npos)
            << what;
        EXPECT_NE(what.find("): lightwell study plan SCRIPT --participant 1 --out plan.tsv"), std::string::npos)
            << what;
    }
}

INSTANTIATE_TEST_SUITE_P(Commits, OldRecords, testing::Values("7d477989"),
                         [](auto const& commit) { return "of_" + std::string(commit.param); });

} // namespace
} // namespace study::test
