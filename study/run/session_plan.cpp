#include "study/run/session_plan.h"

#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "study/journal/journal_file.h"
#include "study/journal/journal_folders.h"
#include "study/run/session.h"

#include <cmath>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

/// Whether entries of a journal can be of a plan.
class EntryCheck {
public:
    EntryCheck(Script const& s, Plan const& plan) : s_(s), plan_(plan) {}

    std::string flaw(JournalEntry const& entry)
    {
        if (std::holds_alternative<SessionStarted>(entry)) hashes_.clear(); // another version may hash otherwise
        if (auto const* const trial = std::get_if<TrialDone>(&entry)) return flaw_of_trial(*trial);
        if (auto const* const step = std::get_if<StepDone>(&entry)) return flaw_of_step(*step);
        if (auto const* const items = std::get_if<QuestionnaireDone>(&entry)) return flaw_of_items(*items);
        return {};
    }

private:
    PlanStep const* at(int step) const
    {
        return step >= 0 && step < int(plan_.steps.size()) ? &plan_.steps[std::size_t(step)] : nullptr;
    }

    std::string flaw_of_trial(TrialDone const& done)
    {
        PlanStep const* const step = at(done.step);
        if (step == nullptr || step->kind != PlanStepKind::trial)
            return fmt::format("step {} was a trial", done.step + 1);
        Trial const& trial = step->trial;
        bool const has_answer = done.is_correct && !done.response.empty();
        if (has_answer && (trial.answer.empty() || *done.is_correct != (done.response == trial.answer)))
            return fmt::format("the answer '{}' of step {} was judged otherwise", done.response, done.step + 1);
        if (trial.level && done.level && std::abs(*trial.level - *done.level) > 1e-8 * std::abs(*trial.level))
            return fmt::format("step {} had the level {}", done.step + 1, level_text(*done.level));
        for (StimulusShown const& shown : done.shown)
            if (std::string flaw = flaw_of_stimulus(*step, done, shown); !flaw.empty()) return flaw;
        return {};
    }

    /// One stimulus has one hash of its settings.
    std::string flaw_of_stimulus(PlanStep const& step, TrialDone const& done, StimulusShown const& shown)
    {
        Trial const& trial = step.trial;
        bool const is_reference = shown.letter == 'r';
        std::size_t const index = std::size_t(shown.letter - 'a');
        if (is_reference ? !trial.reference : index >= trial.stimuli.size())
            return fmt::format("step {} showed a stimulus {}", done.step + 1, shown.letter);
        Block const& block = s_.blocks[std::size_t(step.block)];
        bool const is_open = trial.is_open_pair || block.task == Task::adjustment || !done.chosen.empty();
        if (is_open || shown.settings_sha256.empty()) return {};
        Stimulus stimulus = is_reference ? *trial.reference : trial.stimuli[index];
        if (stimulus.is_varied && !stimulus.level) stimulus.level = done.level;
        auto const [known, is_new] =
            hashes_.try_emplace({step.block, settings_of(s_, block, stimulus)}, shown.settings_sha256);
        if (is_new || known->second == shown.settings_sha256) return {};
        return fmt::format("stimulus {} of step {} had other settings", shown.letter, done.step + 1);
    }

    std::string flaw_of_step(StepDone const& done) const
    {
        PlanStep const* const step = at(done.step);
        bool const is_trial = step && step->kind == PlanStepKind::trial;
        bool const is_walk = is_trial && s_.blocks[std::size_t(step->block)].task == Task::free_walk;
        if (step && (!is_trial || is_walk || done.reason == "skipped")) return {};
        return fmt::format("step {} was no trial", done.step + 1);
    }

    std::string flaw_of_items(QuestionnaireDone const& done) const
    {
        PlanStep const* const step = at(done.step);
        int which = step ? step->questionnaire : -1;
        if (step && step->block >= 0) which = s_.blocks[std::size_t(step->block)].questionnaire;
        if (which >= 0 && s_.questionnaires[std::size_t(which)].items.size() == done.answers.size()) return {};
        return fmt::format("step {} was a questionnaire of {} items", done.step + 1, done.answers.size());
    }

    Script const& s_;
    Plan const& plan_;
    std::map<std::pair<int, Patch>, std::string> hashes_; ///< by block and settings
};

/// Chooses among the plan in the folder and the plan that this version makes.
class PlanChoice {
public:
    PlanChoice(Script const& s, SessionRecord const& record, std::filesystem::path const& folder)
        : s_(s),
          record_(record),
          start_(std::get<SessionStarted>(record.entries.front())),
          file_(folder / "plan.tsv")
    {
        std::error_code none;
        if (std::filesystem::exists(file_, none)) kept_ = gi::read_text(file_);
        try {
            made_ = make_plan(s, start_.participant);
            made_table_ = plan_table(s, *made_);
        } catch (ScriptError const& e) {
            cannot_make_ = e.what();
        }
    }

    SessionPlan choose() const
    {
        std::string const& hash = start_.plan_sha256;
        if (kept_ && (hash.empty() || gi::sha256(*kept_) == hash)) {
            if (made_ && *kept_ == made_table_) return {*made_, PlanSource::same, made_table_, ""};
            return {read(), PlanSource::recorded, *kept_,
                    fmt::format("this version makes another plan than {}, the recorded one is used: {}", version(),
                                difference())};
        }
        if (made_ && gi::sha256(made_table_) == hash)
            return {*made_, PlanSource::same, made_table_,
                    kept_ ? "plan.tsv was changed after the session began; the plan that the journal names is "
                            "computed again"
                          : ""};
        return assume();
    }

private:
    Plan read() const { return read_plan(s_, start_.participant, *kept_, file_.string()); }
    std::string version() const { return "version " + start_.version; }
    std::string difference() const
    {
        return made_ ? plan_difference(*kept_, made_table_) : "it makes none (" + cannot_make_ + ")";
    }

    SessionPlan assume() const
    {
        std::string const lost = kept_ ? "plan.tsv was changed after the session began" : "plan.tsv is missing";
        std::string why;
        if (kept_) try {
                Plan plan = read();
                why = contradiction(s_, plan, record_);
                if (why.empty())
                    return {std::move(plan), PlanSource::assumed, *kept_,
                            lost + "; it is used as it is, since nothing in the journal contradicts it"};
            } catch (ScriptError const& e) {
                why = e.what();
            }
        if (made_ && (why = contradiction(s_, *made_, record_)).empty())
            return {*made_, PlanSource::assumed, made_table_,
                    lost + (start_.plan_sha256.empty() ? "" : ", and " + version() + " made another plan") +
                        "; assumed is the plan that this version makes, which nothing in the journal contradicts"};
        throw ScriptError(file_.string(), {}, "the plan of this session is lost",
                          fmt::format("{}, and the journal contradicts the plan that this version makes: {}", lost,
                                      why.empty() ? cannot_make_ : why),
                          fmt::format("restore the file from a copy, or write it by {} (git {}): lightwell study "
                                      "plan SCRIPT --participant {} --out plan.tsv",
                                      version(), start_.git_hash, start_.participant));
    }

    Script const& s_;
    SessionRecord const& record_;
    SessionStarted const& start_;
    std::filesystem::path file_;
    std::optional<std::string> kept_;
    std::optional<Plan> made_; ///< none: this version cannot plan the script
    std::string made_table_, cannot_make_;
};

} // namespace

std::string contradiction(Script const& script, Plan const& plan, SessionRecord const& record)
{
    EntryCheck check(script, plan);
    for (JournalEntry const& entry : record.entries)
        if (std::string flaw = check.flaw(entry); !flaw.empty()) return flaw;
    return {};
}

SessionPlan recorded_plan(Script const& script, SessionRecord const& record, std::filesystem::path const& folder)
{
    return PlanChoice(script, record, folder).choose();
}

SessionPlan plan_to_run(Script const& script, int participant, SessionSettings const& settings)
{
    auto const folder = session_folder(settings.dir, participant_id(script, participant), settings.session);
    std::error_code none;
    if (settings.start == SessionStart::go_on && std::filesystem::exists(folder / "journal.jsonl", none)) {
        SessionRecord const record = read_journal(folder / "journal.jsonl").record;
        auto const* const start =
            record.entries.empty() ? nullptr : std::get_if<SessionStarted>(&record.entries.front());
        // Others are refused when the journal is opened.
        if (start && start->participant == participant && start->script_sha256 == gi::sha256(settings.script_text))
            return recorded_plan(script, record, folder);
    }
    SessionPlan made{make_plan(script, participant), PlanSource::same, "", ""};
    made.table = plan_table(script, made.plan);
    return made;
}

} // namespace study
