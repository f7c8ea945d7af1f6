#include "study/journal/journal_file.h"
#include "study/journal/moments.h"
#include "study/script/script_error.h"
#include "tests/study_simulate/support.h"

namespace study::test {
namespace {

namespace fs = std::filesystem;

Script example(std::string const& name)
{
    return parse_script(file_text(LIGHTWELL_SOURCE_DIR "/data/study/" + name + ".yaml"), name);
}

SessionSettings settings_in(fs::path const& dir, SessionStart start = SessionStart::begin)
{
    SessionSettings settings;
    settings.dir = dir;
    settings.start = start;
    return settings;
}

template <class Entry>
std::vector<Entry> entries_of(fs::path const& folder)
{
    std::vector<Entry> out;
    for (JournalEntry const& e : read_journal(folder / "journal.jsonl").record.entries)
        if (auto const* const entry = std::get_if<Entry>(&e)) out.push_back(*entry);
    return out;
}

TEST(Simulate, EveryShippedExampleToItsEnd)
{
    TemporaryFolder const dir;
    for (auto const& entry : fs::directory_iterator(LIGHTWELL_SOURCE_DIR "/data/study")) {
        Script const s = example(entry.path().stem().string());
        for (int p = 1; p <= 2; ++p) {
            SessionOutcome const o =
                simulate_session(s, p, draw_observer(usual_observers(s), 3, p), settings_in(dir / s.id), 0);
            EXPECT_TRUE(o.is_complete) << s.id << ": " << o.reason;
            for (TrialDone const& t : entries_of<TrialDone>(o.folder)) {
                EXPECT_FALSE(t.shown.empty());
                for (std::size_t i = 1; i < t.shown.size(); ++i)
                    EXPECT_GE(t.shown[i].onset_s, t.shown[i - 1].onset_s);
                EXPECT_GE(*t.response_s, t.shown.back().onset_s);
            }
        }
    }
}

TEST(Simulate, TakesAsLongAsThePlanExpects)
{
    TemporaryFolder const dir;
    Script const s = example("visibility2026");
    SessionOutcome const o =
        simulate_session(s, 1, draw_observer(usual_observers(s), 3, 1), settings_in(dir.path()), 0);
    double const simulated = entries_of<SessionEnded>(o.folder).at(0).time_s;
    EXPECT_NEAR(simulated, double(make_plan(s, 1).duration_us) * 1e-6, 0.25 * simulated);
    auto const record = read_journal(o.folder / "journal.jsonl").record;
    EXPECT_NEAR(*last_unix_time(record) - *unix_time(entries_of<SessionStarted>(o.folder).at(0).utc), simulated,
                40);
    for (JournalEntry const& e : record.entries)
        if (auto const* const note = std::get_if<NoteTaken>(&e)) ADD_FAILURE() << note->kind << ": " << note->text;
}

TEST(Simulate, BadTrialsComeAtTheirRateAndAgain)
{
    TemporaryFolder const dir;
    Script const s = example("visibility2026");
    ObserverModel m = usual_observers(s);
    m.dropped = 0.2;
    int bad = 0, all = 0;
    for (int p = 1; p <= 4; ++p) {
        SessionOutcome const o = simulate_session(s, p, draw_observer(m, 3, p), settings_in(dir.path()), 0);
        for (TrialDone const& t : entries_of<TrialDone>(o.folder)) {
            ++all;
            bad += t.reason == "dropped_frames";
            EXPECT_EQ(t.is_valid, t.reason.empty());
        }
    }
    EXPECT_NEAR(double(bad) / all, 0.2, near(0.2, all));
}

TEST(Simulate, AnswersDoNotDependOnWhatWasAskedBefore)
{
    // In two halves, the second after the first was aborted by a full stop of the process.
    TemporaryFolder const dir;
    Script const s = example("staircase");
    Observer const o = draw_observer(usual_observers(s), 3, 1);
    SessionOutcome const whole = simulate_session(s, 1, o, settings_in(dir / "a"), 0);
    SessionSettings cut = settings_in(dir / "b");
    struct Killed {};
    int kept = 0;
    cut.on_kept = [&](JournalEntry const&) {
        if (++kept == 77) throw Killed{};
    };
    EXPECT_THROW(simulate_session(s, 1, o, cut, 0), Killed);
    SessionOutcome const rest = simulate_session(s, 1, o, settings_in(dir / "b", SessionStart::go_on), 60);
    EXPECT_TRUE(rest.is_complete);
    auto const a = entries_of<TrialDone>(whole.folder), b = entries_of<TrialDone>(rest.folder);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].step, b[i].step);
        EXPECT_EQ(a[i].level, b[i].level);
        EXPECT_EQ(a[i].response, b[i].response);
        EXPECT_EQ(a[i].value, b[i].value);
        EXPECT_EQ(a[i].shown[0].settings_sha256, b[i].shown[0].settings_sha256);
    }
    EXPECT_NEAR(entries_of<SessionStarted>(rest.folder).at(1).gap_s, 60, 0.01);
}

TEST(Simulate, ADisplayThatIsTooUnsteadyIsRefused)
{
    TemporaryFolder const dir;
    Script const s = example("visibility2026"); // vsync: required
    ObserverModel m = usual_observers(s);
    m.period_sd_ms = 4;
    EXPECT_THROW(simulate_session(s, 1, draw_observer(m, 3, 1), settings_in(dir.path()), 0), gi::InputError);
    EXPECT_TRUE(fs::is_empty(dir.path()));
}

TEST(Simulate, OneFolderHasOneTruth)
{
    TemporaryFolder const dir;
    keep_truth(dir.path(), "a");
    keep_truth(dir.path(), "a");
    EXPECT_THROW(keep_truth(dir.path(), "b"), gi::InputError);
    EXPECT_EQ(file_text(truth_file(dir.path())), "a");
}

} // namespace
} // namespace study::test
