// QUEST+ of several settings in simulated sessions: levels in the record, resumed, parameters in the analysis.

#include "study/analysis/analysis.h"
#include "study/analysis/result_tables.h"
#include "study/journal/journal_file.h"
#include "study/script/procedure_settings.h"
#include "tests/study_simulate/support.h"

#include <set>

namespace study::test {
namespace {

std::string const kScript =
    "factors: {q: {plain: {exposure: 0}}}\nreference: {q: plain}\ndefaults: {stimulus_ms: 500}\nsequence: "
    "[b]\nblocks:\n"
    "  b:\n    task: 2ifc\n"
    "    compare: {vary: light.0.scale, scale: log10, range: [0.01, 1], harder: down, also: {camera.fov: {name: "
    "fov, "
    "scale: log2, range: [10, 80]}}}\n"
    "    procedure:\n      method: questplus\n      levels: 0.01..1/9\n      also: {fov: [10, 20, 40, 80]}\n"
    "      threshold: 0.02..0.5/6\n      slope: 3\n      guess: 0.5\n      lapse: 0.02\n"
    "      parameters: {best: [14, 28, 56], width: [1, 2]}\n"
    "      psychometric: guess + (1 - guess - lapse) * (1 - exp(-(x / (threshold * 2 ^ ((log2(fov / best) / "
    "width) ^ "
    "2)))^slope))\n      stop: {trials: 60}\n    practice: {trials: 2}\n";

std::vector<TrialDone> trials_of_session(std::filesystem::path const& folder)
{
    std::vector<TrialDone> out;
    for (JournalEntry const& e : read_journal(folder / "journal.jsonl").record.entries)
        if (auto const* const t = std::get_if<TrialDone>(&e)) out.push_back(*t);
    return out;
}

TEST(SeveralSettings, AreChosenRecordedResumedAndAnalysed)
{
    Script const s = parse(kScript);
    Block const& b = s.blocks[0];
    ASSERT_TRUE(b.procedures[0].is_many());
    ObserverModel m = usual_observers(s);
    m.dropped = m.between_sd = 0;
    for (VariedModel& v : m.varied) v.between_sd = 0;
    TemporaryFolder const whole, parts;
    SessionSettings settings;
    settings.dir = whole.path();
    SessionOutcome const o = simulate_session(s, 1, draw_observer(m, 3, 1), settings, 0);
    ASSERT_TRUE(o.is_complete) << o.reason;
    std::set<std::string> chosen;
    std::vector<std::string> all;
    for (TrialDone const& t : trials_of_session(o.folder)) {
        all.push_back(t.chosen);
        if (t.chosen.empty()) continue; // practice
        chosen.insert(t.chosen);
        EXPECT_EQ(further_of_text(*b.compare, t.chosen).size(), 1u) << t.chosen;
    }
    EXPECT_GE(chosen.size(), 3u) << "levels of the field of view";

    settings.dir = parts.path();
    int left = 20;
    settings.on_kept = [&](JournalEntry const& e) {
        if (std::holds_alternative<TrialDone>(e) && --left == 0) throw std::runtime_error("stopped");
    };
    EXPECT_THROW(simulate_session(s, 1, draw_observer(m, 3, 1), settings, 0), std::runtime_error);
    settings.on_kept = {};
    settings.start = SessionStart::go_on;
    std::vector<std::string> resumed;
    for (TrialDone const& t :
         trials_of_session(simulate_session(s, 1, draw_observer(m, 3, 1), settings, 0).folder))
        resumed.push_back(t.chosen);
    EXPECT_EQ(resumed, all);

    std::vector<RecordedSession> const sessions{
        {make_plan(s, 1), read_journal(o.folder / "journal.jsonl").record}};
    Analysis const a = analyze(s, sessions);
    ASSERT_EQ(a.blocks.size(), 1u);
    ASSERT_EQ(a.blocks[0].runs.size(), 1u);
    ThresholdRun const& run = a.blocks[0].runs[0];
    EXPECT_EQ(run.note, "");
    ASSERT_EQ(run.parameters.size(), 6u);
    EXPECT_EQ(run.parameters[4].name, "best");
    double const truth = m.varied[0].threshold;
    EXPECT_NEAR(std::log(run.parameters[0].mean / truth), 0, 0.7) << run.parameters[0].mean << " for " << truth;
    EXPECT_TRUE(a.blocks[0].curves.empty());
}

TEST(SeveralSettings, MistakesAreTold)
{
    for (auto const& [what, by, mentions] : {
             std::tuple{"also: {fov: [10, 20, 40, 80]}", "also: {fvo: [10, 20]}", "did you mean 'fov'?"},
             {"also: {fov: [10, 20, 40, 80]}", "also: {fov: [10, 200]}", "it must lie between 10 and 80"},
             {"      also: {fov: [10, 20, 40, 80]}\n", "", "no levels of 'fov'"},
             {"log2(fov / best)", "log2(fow / best)", "did you mean 'fov'?"},
             {"parameters: {best", "parameters: {slope", "has that name already"},
             {"psychometric: guess +", "psychometric: 5 + guess +", "a proportion lies between 0 and 1"},
             {"method: questplus", "method: constant", "unknown key"},
             {"range: [10, 80]", "range: [80, 10]", "does not rise"},
             {"name: fov, ", "nmae: fov, ", "did you mean 'name'?"},
         }) {
        std::string text = "schema: study/1\nid: t\nseed: 5\nparticipants: {count: 2}\n" + kScript;
        text.replace(text.find(what), std::string(what).size(), by);
        std::string all;
        for (ScriptError const& e : read_script(text, "t.yaml").mistakes.in_order())
            all += std::string(e.what()) + "\n";
        EXPECT_NE(all.find(mentions), std::string::npos) << by << "\n" << all;
    }
}

} // namespace
} // namespace study::test
