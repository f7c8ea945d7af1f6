// Sessions with active pairs: reproducible, resumable, with the shown pairs in the record.

#include "study/journal/journal_file.h"
#include "study/tables/recorded_session.h"
#include "tests/study_simulate/support.h"

namespace study::test {
namespace {

Script active(std::string const& more = "")
{
    return parse(
        "factors:\n  q: [a, b, c, d, e]\n  scene: [x, y]\nsequence: [p]\nblocks:\n  p:\n    task: pair\n"
        "    pairs: {factor: q, sampling: active, trials: 20" +
        more + "}\n    cross: [scene]\n    practice: {trials: 2}\n    catch: {every: 10, better: a, worse: e}\n");
}

/// Everybody the same, no lapses, no dropped frames.
ObserverModel exact_model(Script const& s)
{
    ObserverModel m = usual_observers(s);
    m.between_sd = m.lapse = m.side_bias = m.dropped = 0;
    return m;
}

std::vector<TrialDone> trials_in(std::filesystem::path const& folder)
{
    std::vector<TrialDone> out;
    for (JournalEntry const& e : read_journal(folder / "journal.jsonl").record.entries)
        if (auto const* const t = std::get_if<TrialDone>(&e)) out.push_back(*t);
    return out;
}

std::vector<std::string> chosen_in(std::filesystem::path const& folder)
{
    std::vector<std::string> out;
    for (TrialDone const& t : trials_in(folder)) out.push_back(t.chosen);
    return out;
}

SessionOutcome simulate(Script const& s, std::filesystem::path const& dir, int participant, ObserverModel const& m,
                        SessionStart start = SessionStart::begin, int kept = 0)
{
    SessionSettings settings;
    settings.dir = dir;
    settings.start = start;
    int left = kept;
    if (kept > 0)
        settings.on_kept = [&](JournalEntry const& e) {
            if (std::holds_alternative<TrialDone>(e) && --left == 0) throw std::runtime_error("stopped");
        };
    return simulate_session(s, participant, draw_observer(m, 3, participant), settings, 0);
}

TEST(ActiveSessions, ArePlannedWithoutPairsAndRecordedWithThem)
{
    TemporaryFolder const dir;
    Script const s = active();
    Plan const plan = make_plan(s, 1);
    EXPECT_NE(plan_table(s, plan).find("n/a"), std::string::npos);
    SessionOutcome const o = simulate(s, dir.path(), 1, exact_model(s));
    ASSERT_TRUE(o.is_complete) << o.reason;
    int open = 0;
    for (TrialDone const& t : trials_in(o.folder)) {
        Trial const& planned = plan.steps[std::size_t(t.step)].trial;
        EXPECT_EQ(planned.is_open_pair, !t.chosen.empty());
        open += planned.is_open_pair;
    }
    EXPECT_EQ(open, 40);
    RecordedSession session{plan, read_journal(o.folder / "journal.jsonl").record};
    fill_chosen(s, session);
    for (TrialRow const& row : trial_rows(s, session)) {
        EXPECT_FALSE(row.step->trial.is_open_pair);
        if (row.done->chosen.empty()) continue;
        auto const& levels = s.factors[0].levels;
        EXPECT_EQ(levels[std::size_t(row.step->trial.stimuli[0].levels[0])].name + "/" +
                      levels[std::size_t(row.step->trial.stimuli[1].levels[0])].name,
                  row.done->chosen);
    }
}

TEST(ActiveSessions, DependOnlyOnSeedParticipantAndAnswers)
{
    for (char const* const batch : {"", ", batch: spanning_tree"}) {
        Script const s = active(batch);
        TemporaryFolder const one, two, other;
        ObserverModel const m = exact_model(s);
        auto const first = chosen_in(simulate(s, one.path(), 1, m).folder);
        EXPECT_EQ(first, chosen_in(simulate(s, two.path(), 1, m).folder));
        EXPECT_NE(first, chosen_in(simulate(s, one.path(), 2, m).folder));
        ObserverModel reversed = m;
        std::reverse(reversed.quality[0].begin(), reversed.quality[0].end());
        EXPECT_NE(first, chosen_in(simulate(s, other.path(), 1, reversed).folder));
    }
}

TEST(ActiveSessions, AreResumedWithTheSamePairs)
{
    Script const s = active();
    ObserverModel m = exact_model(s);
    m.dropped = 0.1; // some trials are repeated
    TemporaryFolder const whole;
    auto const expected = chosen_in(simulate(s, whole.path(), 1, m).folder);
    for (int const kept : {1, 7, 20, 33}) {
        TemporaryFolder const parts;
        EXPECT_THROW(simulate(s, parts.path(), 1, m, SessionStart::begin, kept), std::runtime_error);
        EXPECT_EQ(chosen_in(simulate(s, parts.path(), 1, m, SessionStart::go_on).folder), expected) << kept;
    }
}

TEST(ActiveSessions, RefuseWhatTheyCannotHave)
{
    auto const told = [&](std::string const& text) {
        return read_script("schema: study/1\nid: t\nseed: 5\nparticipants: {count: 2}\nfactors: {q: [a, b, c]}\n"
                           "sequence: [p]\nblocks:\n  p: {" +
                               text + "}\n",
                           "t.yaml")
            .mistakes.in_order();
    };
    for (auto const& [text, mentions] : {
             std::pair{"task: pair, pairs: {factor: q, sampling: active}", "has no 'trials'"},
             {"task: pair, pairs: {factor: q, trials: 9}", "'trials' of pairs that are all shown"},
             {"task: pair, pairs: {factor: q, sampling: actve, trials: 9}", "did you mean 'active'?"},
             {"task: pair, pairs: {factor: q, sampling: active, trials: 9, order: both}", "an order of pairs"},
             {"task: pair, pairs: {factor: q, sampling: active, trials: 9}, repeats: 2", "'repeats' of pairs"},
             {"task: oddity, pairs: {factor: q, sampling: active, trials: 9}", "active sampling of pairs in task"},
             {"task: pair, pairs: {factor: q, sampling: active, trials: 9}, constraints: [{no_repeat: pair}]",
              "a rule for pairs"},
         }) {
        auto const mistakes = told(text);
        ASSERT_FALSE(mistakes.empty()) << text;
        EXPECT_NE(std::string(mistakes[0].what()).find(mentions), std::string::npos) << mistakes[0].what();
    }
    EXPECT_TRUE(told("task: pair, pairs: {factor: q, sampling: active, trials: 9}").empty());
}

} // namespace
} // namespace study::test
