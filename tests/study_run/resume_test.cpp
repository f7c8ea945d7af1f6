// Interrupted sessions, and changes after which they must not be resumed.

#include "gi/core/durable_file.h"
#include "tests/study_run/support.h"

namespace study::test {
namespace {

namespace fs = std::filesystem;

TEST(Resume, NotesThatTheWallClockWasChanged)
{
    TemporaryFolder const dir;
    TestPresenter p;
    SessionSettings settings = settings_in(dir.path());
    settings.unix_s = [&] { return 1795334400 + p.clock_s - (p.shown.size() >= 5 ? 3600 : 0); };
    p.on_wish = [&] { return p.shown.size() > 8 ? ExperimenterAction::abort : ExperimenterAction::go_on; };
    run_session(rating_script(), 1, p, settings);
    auto const journal = journal_in(dir.path());
    ASSERT_EQ(notes_of(journal, "clock_changed").size(), 1u);
    EXPECT_NE(notes_of(journal, "clock_changed")[0].text.find("-3600.000 s"), std::string::npos);

    // Goes on before it was cut off, as the wall clock has it: the gap is unknown, so practice comes again.
    settings.start = SessionStart::go_on;
    settings.unix_s = [&] { return 1795330000 + p.clock_s; };
    p.on_wish = [] { return ExperimenterAction::go_on; };
    p.said.clear();
    EXPECT_TRUE(run_session(rating_script(), 1, p, settings).is_complete);
    EXPECT_EQ(notes_of(journal, "clock_changed").size(), 2u);
    EXPECT_LT(entries_of<SessionStarted>(journal).at(1).gap_s, -1000);
    EXPECT_EQ(p.said.at(0), "Say how real it looks.");
}

TEST(Resume, OnlyOneProcessHasIt)
{
    TemporaryFolder const dir;
    TestPresenter p, other;
    Script const s = rating_script();
    std::string second;
    p.on_show = [&](TrialRequest const& r, TrialDone&) {
        if (r.step_index == 5) second = refusal(s, other, settings_in(dir.path(), SessionStart::go_on));
    };
    EXPECT_TRUE(run_session(s, 1, p, settings_in(dir.path())).is_complete);
    EXPECT_NE(second.find("another process has its journal"), std::string::npos) << second;
    EXPECT_TRUE(other.shown.empty());
}

TEST(Resume, GoesOnOnlyWithWhatItBeganWith)
{
    TemporaryFolder const dir;
    TestPresenter p;
    p.on_wish = [&] { return p.shown.size() > 5 ? ExperimenterAction::abort : ExperimenterAction::go_on; };
    Script const s = rating_script();
    run_session(s, 1, p, settings_in(dir.path()));
    std::string const before = file_text(journal_in(dir.path()));
    SessionSettings settings = settings_in(dir.path(), SessionStart::go_on);
    settings.script_text = "another";
    EXPECT_NE(refusal(s, p, settings).find("the script is not the one"), std::string::npos);
    settings = settings_in(dir.path(), SessionStart::go_on);
    settings.is_simulated = true;
    EXPECT_NE(refusal(s, p, settings).find("a person's"), std::string::npos);
    EXPECT_EQ(file_text(journal_in(dir.path())), before);

    // A journal of somebody else in this folder.
    fs::create_directories(session_folder(dir.path(), "P002", 1));
    fs::copy(journal_in(dir.path()), journal_in(dir.path(), "P002"));
    EXPECT_THROW(run_session(s, 2, p, settings_in(dir.path(), SessionStart::go_on)), gi::InputError);
}

/// As if another version had made the plan: this one plans a repeat more.
TEST(Resume, FollowsTheRecordedPlanAndSaysWhatDiffers)
{
    TemporaryFolder const dir;
    TestPresenter p;
    p.on_wish = [&] { return p.shown.size() > 5 ? ExperimenterAction::abort : ExperimenterAction::go_on; };
    fs::path const plan = run_session(rating_script(), 1, p, settings_in(dir.path())).folder / "plan.tsv";
    std::string const recorded = file_text(plan);
    p.on_wish = [] { return ExperimenterAction::go_on; };
    SessionOutcome const o = run_session(rating_script(5), 1, p, settings_in(dir.path(), SessionStart::go_on));
    EXPECT_TRUE(o.is_complete) << o.reason;
    EXPECT_NE(o.plan_remark.find("steps differ"), std::string::npos) << o.plan_remark;
    EXPECT_EQ(file_text(plan), recorded);
    EXPECT_EQ(entries_of<TrialDone>(journal_in(dir.path())).size(), 2u + 4 * 6) << "practice, four repeats";
    ASSERT_EQ(notes_of(journal_in(dir.path()), "warning").size(), 1u);
    EXPECT_EQ(notes_of(journal_in(dir.path()), "warning")[0].text, o.plan_remark);
    auto const parts = entries_of<SessionStarted>(journal_in(dir.path()));
    EXPECT_EQ(parts.at(0).plan_sha256, parts.at(1).plan_sha256);
}

TEST(Resume, BeginsWhereNothingIsThereToGoOnWith)
{
    TemporaryFolder const dir;
    TestPresenter p;
    gi::make_folder(session_folder(dir.path(), "P001", 1));
    gi::write_durably(journal_in(dir.path()), ""); // killed before the first entry
    EXPECT_NE(refusal(rating_script(), p, settings_in(dir.path())), "");
    EXPECT_TRUE(run_session(rating_script(), 1, p, settings_in(dir.path(), SessionStart::go_on)).is_complete);
    EXPECT_TRUE(run_session(rating_script(), 2, p, settings_in(dir.path(), SessionStart::go_on)).is_complete);
    EXPECT_EQ(entries_of<SessionStarted>(journal_in(dir.path())).at(0).part, 1);
}

TEST(Resume, CutAnywhereGoesOnAsIfItHadNotBeen)
{
    TemporaryFolder const dir;
    TestPresenter whole;
    Script const s = adaptive_script();
    auto const answers = [](TrialRequest const& r, TrialDone& t) {
        bool const is_right = (r.step_index * 7919 + r.attempt * 104729) % 10 < 7;
        if (!is_right) t.response = t.response == "first" ? "second" : "first";
        if (r.step_index % 13 == 5 && r.attempt == 1) t.shown[0].frames_dropped = 3;
    };
    whole.on_show = answers;
    SessionSettings first = settings_in(dir / "whole");
    first.unix_s = [&] { return 1795334400 + whole.clock_s; };
    run_session(s, 1, whole, first);
    std::string const text = file_text(journal_in(dir / "whole"));
    auto const expected = entries_of<TrialDone>(journal_in(dir / "whole"));

    for (std::size_t size = 1; size < text.size(); size += 1499) {
        fs::path const at = dir / ("cut" + std::to_string(size));
        gi::make_folder(session_folder(at, "P001", 1));
        gi::write_durably(journal_in(at), text.substr(0, size));
        TestPresenter p;
        p.on_show = answers;
        SessionSettings settings = settings_in(at, SessionStart::go_on);
        settings.unix_s = [&] { return 1795335000 + p.clock_s; };
        SessionOutcome const o = run_session(s, 1, p, settings);
        ASSERT_TRUE(o.is_complete);
        ASSERT_EQ(o.torn_bytes, size - (text.substr(0, size).rfind('\n') + 1));
        auto const trials = entries_of<TrialDone>(journal_in(at));
        ASSERT_EQ(trials.size(), expected.size());
        for (std::size_t i = 0; i < trials.size(); ++i) {
            ASSERT_EQ(trials[i].step, expected[i].step);
            ASSERT_EQ(trials[i].attempt, expected[i].attempt);
            ASSERT_EQ(trials[i].level, expected[i].level);
        }
        bool const had_started = size > text.find('\n');
        EXPECT_EQ(notes_of(journal_in(at), "warning").size(), o.torn_bytes > 0 ? 1u : 0u);
        EXPECT_EQ(entries_of<SessionStarted>(journal_in(at)).size(), had_started ? 2u : 1u);
        fs::remove_all(at);
    }
}

TEST(Resume, GoesOnWithTheNextItemOfAQuestionnaire)
{
    TemporaryFolder const dir;
    Script const s = parse_script(R"(schema: study/1
id: t
seed: 1
participants: {count: 1}
sequence: [{questionnaire: q}, {questionnaire: q}]
blocks: {}
questionnaires: {q: {items: [{id: why, text: "Why?", type: text}, {id: sure, text: "Sure?"}, {id: end, text: "End?"}]}}
)",
                                  "t.yaml");
    TestPresenter first;
    first.on_ask = [](QuestionnaireRequest const& r) -> QuestionnaireDone {
        if (r.step == 0) return {0, 0, 1, {{}, 1.0, 1.0}, {"before", "", ""}};
        EXPECT_TRUE(r.given.empty());
        r.keep({r.step, 1, 0, {}, "because"});
        r.keep({r.step, 2, 1, 3.0, ""});
        throw std::runtime_error("it was killed");
    };
    EXPECT_FALSE(run_session(s, 1, first, settings_in(dir.path())).is_complete);
    TestPresenter second;
    second.on_ask = [](QuestionnaireRequest const& r) -> QuestionnaireDone {
        EXPECT_EQ(r.step, 1);
        EXPECT_EQ(r.given.size(), 2u);
        EXPECT_EQ(r.given.at(0).text, "because");
        EXPECT_EQ(r.given.at(1).answer, 3.0);
        return {1, 5, 6, {{}, 3.0, 4.0}, {"because"}};
    };
    EXPECT_TRUE(run_session(s, 1, second, settings_in(dir.path(), SessionStart::go_on)).is_complete);
    auto const done = entries_of<QuestionnaireDone>(journal_in(dir.path()));
    ASSERT_EQ(done.size(), 2u);
    EXPECT_EQ(done[1].texts, (std::vector<std::string>{"because", "", ""}));
}

TEST(Resume, WithoutADisplayChangesNothing)
{
    TemporaryFolder const dir;
    TestPresenter p;
    Script const s = rating_script();
    p.has_display = false;
    EXPECT_THROW(run_session(s, 1, p, settings_in(dir / "data")), std::runtime_error);
    EXPECT_FALSE(fs::exists(dir / "data"));
    p.has_display = true;
    p.on_wish = [&] { return p.shown.size() > 5 ? ExperimenterAction::abort : ExperimenterAction::go_on; };
    run_session(s, 1, p, settings_in(dir / "data"));
    std::string const before = file_text(journal_in(dir / "data"));
    p.has_display = false;
    EXPECT_THROW(run_session(s, 1, p, settings_in(dir / "data", SessionStart::go_on)), std::runtime_error);
    EXPECT_EQ(file_text(journal_in(dir / "data")), before);
}

TEST(Resume, WritesAPlanThatIsMissing)
{
    TemporaryFolder const dir;
    TestPresenter p;
    p.on_wish = [&] { return p.shown.size() > 5 ? ExperimenterAction::abort : ExperimenterAction::go_on; };
    Script const s = rating_script();
    fs::path const plan = run_session(s, 1, p, settings_in(dir.path())).folder / "plan.tsv";
    std::string const text = file_text(plan);
    p.on_wish = [] { return ExperimenterAction::go_on; };
    for (bool const was_complete : {false, true}) {
        fs::remove(plan);
        EXPECT_TRUE(run_session(s, 1, p, settings_in(dir.path(), SessionStart::go_on)).is_complete);
        EXPECT_EQ(file_text(plan), text) << was_complete;
    }
}

TEST(Resume, OfWhatWasCompleteMakesTheSummaryThatWasMissing)
{
    TemporaryFolder const dir;
    TestPresenter p;
    Script const s = rating_script();
    SessionOutcome const o = run_session(s, 1, p, settings_in(dir.path()));
    std::string const summary = file_text(o.folder / "session.json");
    gi::write_durably(o.folder / "session.json", "{}"); // as after a kill between the journal's last line and this
    EXPECT_TRUE(run_session(s, 1, p, settings_in(dir.path(), SessionStart::go_on)).is_complete);
    EXPECT_EQ(file_text(o.folder / "session.json"), summary);
}

TEST(Resume, RefusesAJournalThatWasChanged)
{
    TemporaryFolder const dir;
    TestPresenter p;
    p.on_wish = [&] { return p.shown.size() > 5 ? ExperimenterAction::abort : ExperimenterAction::go_on; };
    Script const s = rating_script();
    run_session(s, 1, p, settings_in(dir.path()));
    std::string text = file_text(journal_in(dir.path()));
    auto const line = text.find('\n', text.find("trial_done")) + 1; // the second trial goes
    std::string const without = text.substr(0, line) + text.substr(text.find('\n', line) + 1);
    gi::write_durably(journal_in(dir.path()), without);
    std::string const why = refusal(s, p, settings_in(dir.path(), SessionStart::go_on));
    EXPECT_NE(why.find("lines are missing"), std::string::npos) << why;
    EXPECT_EQ(file_text(journal_in(dir.path())), without);
}

} // namespace
} // namespace study::test
