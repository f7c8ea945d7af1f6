#pragma once
// Small scripts, and a presenter that does what a test says.

#include "study/journal/journal_file.h"
#include "study/run/session.h"
#include "study/script/script_file.h"
#include "tests/viewer/run_program.h"

#include <functional>

namespace study::test {

using viewer::test::file_text;
using viewer::test::TemporaryFolder;

inline Script parse(std::string const& body, std::string const& head = "")
{
    return parse_script("schema: study/1\nid: t\nseed: 5\nparticipants: {count: 12" + head + "}\n" + body,
                        "t.yaml");
}

/// A staircase and QUEST+ interleaved, catch trials and breaks.
inline Script adaptive_script(std::string const& timing = "timing: {vsync: record}\n")
{
    return parse(timing + R"(
factors: {scene: [atrium], quality: {many: {paths: 4096}}}
reference: {quality: many}
sequence: [{instructions: "Look."}, paths]
blocks:
  paths:
    task: 2ifc
    prompt: "Which?"
    stimulus_ms: 1000
    compare: {vary: paths, scale: log2, range: [1, 1024], harder: up}
    interleave:
      - {name: down2, method: staircase, up: 1, down: 2, start: 16, steps: [2, 1], stop: {reversals: 4, max_trials: 30}}
      - {name: qp, method: questplus, threshold: 1..1024/21, slope: 2, guess: 0.5, lapse: 0.02, stop: {trials: 12}}
    cross: [scene]
    practice: {trials: 3}
    catch: {every: 7, level: easiest}
    break_every: 10
)");
}

inline Script rating_script(int repeats = 4, std::string const& more = "", std::string const& timing = "")
{
    return parse("timing: {vsync: record" + timing + "}\n" + more + R"(
factors: {scene: [atrium, cornell], bounces: [0, 1, 3]}
sequence: [{questionnaire: sus_presence}, real]
blocks:
  real:
    task: rating
    instructions: "Say how real it looks."
    prompt: "How real?"
    scale: {min: 1, max: 7}
    cross: [scene, bounces]
    practice: {trials: 2}
    repeats: )" + std::to_string(repeats) +
                 "\n");
}

/// Answers at once, and rightly, unless a test says otherwise.
class TestPresenter : public Presenter {
public:
    std::function<void(TrialRequest const&, TrialDone&)> on_show = [](auto const&, auto&) {};
    std::function<QuestionnaireDone(QuestionnaireRequest const&)> on_ask;
    std::function<ExperimenterAction()> on_wish = [] { return ExperimenterAction::go_on; };
    std::vector<NoteTaken> waiting_notes;
    bool agrees = true, display_is_good = true, has_display = true;
    std::vector<TrialRequest> shown;
    std::vector<std::string> said; ///< instructions and prompts of rests
    int asked = 0, consents = 0;
    double clock_s = 0;

    double now() const override { return clock_s; }
    std::vector<std::pair<std::string, std::string>> about() const override { return {{"device", "test"}}; }
    CalibrationDone calibrate(Timing const&) override
    {
        if (!has_display) throw std::runtime_error("there is no display");
        return {600,
                60,
                16.7,
                display_is_good ? 0.1 : 3.0,
                "swap_finish",
                display_is_good,
                display_is_good ? "" : "frames come at 0.06 ms: there is no vsync"};
    }
    bool ask_consent(std::string const& markdown) override
    {
        ++consents;
        said.push_back(markdown);
        return agrees;
    }
    ParticipantAsked ask_participant(std::vector<AskedQuestion> const& questions) override
    {
        ++asked;
        ParticipantAsked out;
        for (AskedQuestion const& q : questions) out.answers.emplace_back(q.id, "x");
        return out;
    }
    StepDone instruct(std::string const& markdown, int step) override { return said_for(markdown, step, 10); }
    StepDone rest(std::string const& prompt, double least_s, int step) override
    {
        return said_for(prompt, step, least_s);
    }
    StepDone walk(TrialRequest const&, std::string const& prompt, double seconds) override
    {
        return said_for(prompt, 0, seconds);
    }
    QuestionnaireDone ask(QuestionnaireRequest const& r) override
    {
        clock_s += 5;
        if (on_ask) return on_ask(r);
        return {0, clock_s - 5, clock_s, std::vector<std::optional<double>>(r.questionnaire->items.size(), 4.0)};
    }
    TrialDone show(TrialRequest const& r) override
    {
        shown.push_back(r);
        TrialDone done;
        clock_s += 1;
        for (char const letter : r.step->trial.order) {
            StimulusShown s;
            s.letter = letter;
            s.onset_s = clock_s;
            s.duration_s = 0.5;
            done.shown.push_back(s);
        }
        done.response = r.step->trial.answer.empty() ? "confirm" : r.step->trial.answer;
        done.response_s = clock_s + 0.7;
        clock_s += 1;
        on_show(r, done);
        return done;
    }
    ExperimenterAction action() override { return on_wish(); }
    std::vector<NoteTaken> notes() override { return std::exchange(waiting_notes, {}); }

private:
    StepDone said_for(std::string const& text, int step, double seconds)
    {
        said.push_back(text);
        clock_s += seconds;
        return {step, clock_s - seconds, clock_s, ""};
    }
};

inline SessionSettings settings_in(std::filesystem::path const& dir, SessionStart start = SessionStart::begin)
{
    SessionSettings s;
    s.dir = dir;
    s.script_text = "script";
    s.start = start;
    s.version = "0.1.0";
    s.git_hash = "abc";
    return s;
}

inline std::filesystem::path journal_in(std::filesystem::path const& dir, std::string const& id = "P001")
{
    return session_folder(dir, id, 1) / "journal.jsonl";
}

template <class Entry>
std::vector<Entry> entries_of(std::filesystem::path const& journal)
{
    std::vector<Entry> out;
    for (JournalEntry const& e : read_journal(journal).record.entries)
        if (auto const* const entry = std::get_if<Entry>(&e)) out.push_back(*entry);
    return out;
}

inline std::vector<NoteTaken> notes_of(std::filesystem::path const& journal, std::string const& kind)
{
    auto notes = entries_of<NoteTaken>(journal);
    std::erase_if(notes, [&](NoteTaken const& n) { return n.kind != kind; });
    return notes;
}

/// What run_session refuses with; empty = it does not.
inline std::string refusal(Script const& script, TestPresenter& presenter, SessionSettings const& settings)
{
    try {
        run_session(script, 1, presenter, settings);
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return {};
}

} // namespace study::test
