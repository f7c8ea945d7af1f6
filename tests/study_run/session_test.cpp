#include "gi/core/durable_file.h"
#include "gi/core/sha256.h"
#include "tests/study_run/support.h"

#include <nlohmann/json.hpp>

namespace study::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> all_files(fs::path const& folder)
{
    std::vector<std::string> out;
    for (auto const& e : fs::recursive_directory_iterator(folder))
        out.push_back(fs::relative(e.path(), folder).string());
    std::sort(out.begin(), out.end());
    return out;
}

TEST(Session, LeavesPlanJournalAndSummary)
{
    TemporaryFolder const dir;
    Script const s = adaptive_script();
    TestPresenter p;
    SessionOutcome const o = run_session(s, 1, p, settings_in(dir / "data"));
    EXPECT_TRUE(o.is_complete);
    EXPECT_EQ(o.folder, dir / "data/sub-P001/ses-01/beh");
    EXPECT_EQ(all_files(o.folder), (std::vector<std::string>{"journal.jsonl", "plan.tsv", "session.json"}));
    EXPECT_EQ(file_text(o.folder / "plan.tsv"), plan_table(s, make_plan(s, 1)));
    auto const journal = journal_in(dir / "data");
    auto const started = entries_of<SessionStarted>(journal);
    ASSERT_EQ(started.size(), 1u);
    EXPECT_EQ(started[0].script_sha256, gi::sha256("script"));
    EXPECT_EQ(started[0].plan_sha256, gi::sha256(plan_table(s, make_plan(s, 1))));
    EXPECT_EQ(started[0].about[0].second, "test");
    auto const trials = entries_of<TrialDone>(journal);
    EXPECT_EQ(trials.size(), p.shown.size());
    for (TrialDone const& t : trials) EXPECT_EQ(t.is_correct, true);
    EXPECT_EQ(trials[0].bookkeeping_ms, 0);
    EXPECT_GT(trials[1].bookkeeping_ms, 0);
    EXPECT_TRUE(entries_of<SessionEnded>(journal).at(0).is_complete);
    auto const j = nlohmann::json::parse(file_text(o.folder / "session.json"));
    EXPECT_EQ(j.at("complete"), true);
    EXPECT_EQ(j.at("trials"), trials.size());
    EXPECT_EQ(j.at("parts").size(), 1u);
}

TEST(Session, ShowsTheLevelsThatItRecords)
{
    TemporaryFolder const dir;
    TestPresenter p;
    Script const s = adaptive_script();
    run_session(s, 1, p, settings_in(dir.path()));
    auto const trials = entries_of<TrialDone>(journal_in(dir.path()));
    for (std::size_t i = 0; i < trials.size(); ++i) {
        EXPECT_EQ(trials[i].level, p.shown[i].level);
        EXPECT_EQ(trials[i].level, p.shown[i].stimuli[0].level);
        EXPECT_EQ(p.shown[i].trials_done, int(i));
    }
}

TEST(Session, FindsBadTrialsItself)
{
    TemporaryFolder const dir;
    TestPresenter p;
    p.on_show = [](TrialRequest const& r, TrialDone& t) {
        if (r.step_index == 5 && r.attempt == 1) t.shown[0].frames_dropped = 1;
        if (r.step_index == 6 && r.attempt == 1) t.response.clear();
        if (r.step_index == 7 && r.attempt == 1) {
            t.is_valid = false;
            t.reason = "lost_focus";
        }
    };
    SessionOutcome const o = run_session(rating_script(), 1, p, settings_in(dir.path()));
    EXPECT_EQ(o.bad_trials, 3);
    auto const trials = entries_of<TrialDone>(journal_in(dir.path()));
    EXPECT_EQ(trials[3].reason, "dropped_frames");
    EXPECT_EQ(trials[4].reason, "timeout");
    EXPECT_EQ(trials[5].reason, "lost_focus");
    ASSERT_EQ(trials.size(), 2u + 24 + 3);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(trials[std::size_t(26 + i)].step, 5 + i);
    EXPECT_FALSE(trials[0].is_correct) << "ratings are not right or wrong";
}

TEST(Session, NeverOverwritesAndSaysWhatToDo)
{
    TemporaryFolder const dir;
    TestPresenter p;
    Script const s = rating_script();
    run_session(s, 1, p, settings_in(dir.path()));
    std::string const before = file_text(journal_in(dir.path()));
    SessionSettings settings = settings_in(dir.path());
    EXPECT_NE(refusal(s, p, settings)
                  .find("participant P001 has a session 1 already (records are never "
                        "overwritten) resume it with --resume, or start another one with --session 2"),
              std::string::npos)
        << refusal(s, p, settings);
    EXPECT_EQ(file_text(journal_in(dir.path())), before);
    settings.session = 2;
    EXPECT_EQ(refusal(s, p, settings), "");
    EXPECT_TRUE(fs::exists(dir / "sub-P001/ses-02/beh/journal.jsonl"));
    EXPECT_NE(refusal(s, p, settings_in(dir.path())).find("--session 3"), std::string::npos);
    // Going on with what is complete does nothing.
    std::size_t const shown = p.shown.size();
    EXPECT_EQ(refusal(s, p, settings_in(dir.path(), SessionStart::go_on)), "");
    EXPECT_EQ(p.shown.size(), shown);
    EXPECT_EQ(file_text(journal_in(dir.path())), before);
}

TEST(Session, RefusesAFolderOfAnotherScript)
{
    TemporaryFolder const dir;
    TestPresenter p;
    Script const s = rating_script();
    run_session(s, 1, p, settings_in(dir.path()));
    auto const before = all_files(dir.path());
    std::size_t const shown = p.shown.size();
    for (SessionStart const start : {SessionStart::begin, SessionStart::go_on})
        for (int const participant : {1, 2}) {
            SessionSettings settings = settings_in(dir.path(), start);
            settings.script_text = "edited";
            settings.session = 2;
            try {
                run_session(s, participant, p, settings);
                ADD_FAILURE() << "participant " << participant;
            } catch (gi::InputError const& e) {
                EXPECT_EQ(e.problem(), "the folder has sessions of another script");
                EXPECT_EQ(e.where().file, journal_in(dir.path()).string());
            }
        }
    EXPECT_EQ(all_files(dir.path()), before);
    EXPECT_EQ(p.shown.size(), shown);
    SessionSettings edited = settings_in(dir.path());
    edited.script_text = "edited";
    EXPECT_EQ(refusal(s, p, edited).find("--session"), std::string::npos) << "that would be refused too";
    gi::write_durably(journal_in(dir.path()), ""); // it had not begun
    EXPECT_TRUE(run_session(s, 2, p, edited).is_complete);
}

TEST(Session, RefusesAFolderWithOtherThings)
{
    TemporaryFolder const dir;
    TestPresenter p;
    gi::make_folder(session_folder(dir.path(), "P001", 1));
    gi::write_durably(session_folder(dir.path(), "P001", 1) / "events.tsv", "data");
    EXPECT_NE(refusal(rating_script(), p, settings_in(dir.path())), "");
    EXPECT_NE(refusal(rating_script(), p, settings_in(dir.path(), SessionStart::go_on)), "");
}

TEST(Session, NamesOfFoldersAreSafe)
{
    for (char const* id : {"", "..", "a/b", "P_1", "P 1", "\xc3\xa4"})
        EXPECT_THROW(session_folder("d", id, 1), gi::InputError) << id;
    for (int const session : {0, -1, 100}) EXPECT_THROW(session_folder("d", "P001", session), gi::InputError);
    EXPECT_EQ(session_folder("d", "P001", 12), "d/sub-P001/ses-12/beh");
}

TEST(Session, RequiresADisplayThatPassesItsTestOrLabelsIt)
{
    TemporaryFolder const dir;
    TestPresenter p;
    p.display_is_good = false;
    std::string const why = refusal(adaptive_script("timing: {vsync: required}\n"), p, settings_in(dir / "data"));
    EXPECT_NE(why.find("there is no vsync"), std::string::npos) << why;
    EXPECT_NE(why.find("vsync: record"), std::string::npos) << why;
    EXPECT_FALSE(fs::exists(dir / "data")) << "nothing has happened";
    EXPECT_EQ(refusal(adaptive_script(), p, settings_in(dir / "data")), "");
    auto const calibration = entries_of<CalibrationDone>(journal_in(dir / "data")).at(0);
    EXPECT_FALSE(calibration.passed);
    EXPECT_EQ(calibration.reason, "frames come at 0.06 ms: there is no vsync");
}

TEST(Session, AsksForConsentFirstAndOnceAndKeepsNothingWithoutIt)
{
    TemporaryFolder const dir;
    gi::write_durably(dir / "consent.md", "I agree.");
    Script const s =
        parse("timing: {vsync: record}\nfactors: {scene: [a, b]}\nsequence: [{free_walk: {duration_s: 3, "
              "condition: {scene: a}}}, w]\nblocks: {w: {task: free_walk, cross: [scene]}}\n",
              ", consent: consent.md, ask: [age_band]");
    TestPresenter p;
    p.agrees = false;
    SessionSettings settings = settings_in(dir / "data");
    settings.script_folder = dir.path();
    SessionOutcome const o = run_session(s, 1, p, settings);
    EXPECT_FALSE(o.is_complete);
    EXPECT_TRUE(o.folder.empty());
    EXPECT_FALSE(fs::exists(dir / "data"));
    EXPECT_EQ(p.said.at(0), "I agree.");

    p.agrees = true;
    p.on_wish = [&] { return p.said.size() > 2 ? ExperimenterAction::abort : ExperimenterAction::go_on; };
    EXPECT_FALSE(run_session(s, 1, p, settings).is_complete);
    p.on_wish = [] { return ExperimenterAction::go_on; };
    settings.start = SessionStart::go_on;
    EXPECT_TRUE(run_session(s, 1, p, settings).is_complete);
    EXPECT_EQ(p.consents, 2);
    EXPECT_EQ(p.asked, 1);
    for (SessionStarted const& started : entries_of<SessionStarted>(journal_in(dir / "data")))
        EXPECT_EQ(started.consent_sha256, gi::sha256("I agree."));
}

TEST(Session, DoesWhatTheExperimenterWishes)
{
    TemporaryFolder const dir;
    TestPresenter p;
    p.on_wish = [&] {
        static int polls = 0;
        ++polls;
        return polls == 4   ? ExperimenterAction::pause
               : polls == 6 ? ExperimenterAction::skip
               : polls == 9 ? ExperimenterAction::abort
                            : ExperimenterAction::go_on;
    };
    p.waiting_notes = {{0.5, "note", "the lamp flickers"}};
    Script const s = rating_script();
    SessionOutcome const o = run_session(s, 1, p, settings_in(dir.path()));
    auto const journal = journal_in(dir.path());
    EXPECT_FALSE(o.is_complete);
    EXPECT_EQ(o.reason, "aborted by the experimenter");
    for (char const* kind : {"note", "pause", "resume", "skip", "abort"})
        EXPECT_EQ(notes_of(journal, kind).size(), 1u) << kind;
    EXPECT_EQ(notes_of(journal, "note")[0].text, "the lamp flickers");
    EXPECT_EQ(p.said.back(), "Pause");
    auto const skipped = entries_of<TrialDone>(journal).back().step;
    EXPECT_FALSE(entries_of<SessionEnded>(journal).at(0).is_complete);
    EXPECT_EQ(nlohmann::json::parse(file_text(o.folder / "session.json")).at("complete"), false);

    SessionOutcome const rest = run_session(s, 1, p, settings_in(dir.path(), SessionStart::go_on));
    EXPECT_TRUE(rest.is_complete);
    auto const trials = entries_of<TrialDone>(journal);
    EXPECT_EQ(trials.size(), 26u);
    EXPECT_EQ(
        std::count_if(trials.begin(), trials.end(), [](TrialDone const& t) { return t.reason == "skipped"; }), 1);
    EXPECT_GT(skipped, 0);
    EXPECT_EQ(nlohmann::json::parse(file_text(o.folder / "session.json")).at("parts").size(), 2u);
}

TEST(Session, WhatWasAbortedIsDoneLater)
{
    std::function<void(TestPresenter&, TrialDone&)> const kinds[] = {
        [](TestPresenter&, TrialDone&) { throw Aborted(); },
        [](TestPresenter& p, TrialDone& t) {
            t.is_valid = false;
            t.reason = "aborted";
            p.waiting_notes = {{p.clock_s, "note", "the participant is unwell"}};
        },
    };
    for (auto const& abort : kinds) {
        TemporaryFolder const dir;
        TestPresenter p;
        p.on_show = [&](TrialRequest const& r, TrialDone& t) {
            if (r.step_index == 8) abort(p, t);
        };
        Script const s = rating_script();
        SessionOutcome const o = run_session(s, 1, p, settings_in(dir.path()));
        EXPECT_EQ(o.reason, "aborted by the experimenter");
        EXPECT_EQ(entries_of<TrialDone>(journal_in(dir.path())).back().step, 7);
        EXPECT_EQ(notes_of(journal_in(dir.path()), "abort").size(), 1u);
        EXPECT_EQ(notes_of(journal_in(dir.path()), "note").size(), &abort == &kinds[1] ? 1u : 0u);
        EXPECT_EQ(notes_of(journal_in(dir.path()), "display_lost").size(), 0u);
        p.on_show = [](auto const&, auto&) {};
        EXPECT_TRUE(run_session(s, 1, p, settings_in(dir.path(), SessionStart::go_on)).is_complete);
        EXPECT_EQ(entries_of<TrialDone>(journal_in(dir.path())).size(), 26u);
    }
}

TEST(Session, KeepsWhoAborted)
{
    TemporaryFolder const dir;
    TestPresenter p;
    p.on_show = [](TrialRequest const& r, TrialDone&) {
        if (r.step_index == 8) throw Aborted("ended by the participant");
    };
    SessionOutcome const o = run_session(rating_script(), 1, p, settings_in(dir.path()));
    EXPECT_EQ(o.reason, "ended by the participant");
    EXPECT_NE(file_text(o.folder / "session.json").find("ended by the participant"), std::string::npos);
}

TEST(Session, EndsWhereTheDisplayIsLostAndGoesOnLater)
{
    TemporaryFolder const dir;
    TestPresenter p;
    p.on_show = [](TrialRequest const& r, TrialDone&) {
        if (r.step_index == 9) throw std::runtime_error("the monitor is gone");
    };
    Script const s = rating_script();
    SessionOutcome const o = run_session(s, 1, p, settings_in(dir.path()));
    EXPECT_FALSE(o.is_complete);
    EXPECT_EQ(o.reason, "the monitor is gone");
    EXPECT_EQ(notes_of(journal_in(dir.path()), "display_lost").size(), 1u);
    p.on_show = [](auto const&, auto&) {};
    EXPECT_TRUE(run_session(s, 1, p, settings_in(dir.path(), SessionStart::go_on)).is_complete);
    EXPECT_EQ(entries_of<TrialDone>(journal_in(dir.path())).size(), 26u);
}

TEST(Session, TellsEachEntryThatIsKept)
{
    TemporaryFolder const dir;
    TestPresenter p;
    SessionSettings settings = settings_in(dir.path());
    std::size_t kept = 0;
    settings.on_kept = [&](JournalEntry const&) { ++kept; };
    SessionOutcome const o = run_session(rating_script(), 1, p, settings);
    EXPECT_EQ(read_journal(o.folder / "journal.jsonl").record.entries.size(), kept);
    EXPECT_GT(kept, 26u);
}

} // namespace
} // namespace study::test
