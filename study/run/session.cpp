#include "study/run/session.h"

#include "gi/core/durable_file.h"
#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "study/journal/moments.h"
#include "study/journal/session_summary.h"
#include "study/run/session_files.h"
#include "study/run/session_plan.h"
#include "study/run/stopwatch.h"
#include "study/run/trial.h"

#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

constexpr double kClockJump_s = 1;

double machine_unix_s()
{
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// A call of the presenter failed: nothing can be shown any more.
struct DisplayLost {
    std::string why;
};

/// Reads all texts before anything is shown; nothing is read from the disk later.
std::map<std::string, std::string> read_texts(Script const& s, Plan const& plan,
                                              std::filesystem::path const& folder)
{
    std::map<std::string, std::string> texts;
    auto const add = [&](std::string const& text) {
        if (is_text_file(text) && !texts.contains(text)) texts[text] = gi::read_text(folder / text);
    };
    add(s.participants.consent);
    for (PlanStep const& step : plan.steps) add(step.text);
    return texts;
}

class Session {
public:
    Session(Script const& script, int participant, Presenter& presenter, SessionSettings const& settings)
        : s_(script),
          p_(presenter),
          settings_(settings),
          planned_(plan_to_run(script, participant, settings)),
          plan_(planned_.plan),
          texts_(read_texts(script, plan_, settings.script_folder)),
          progress_(script, plan_),
          files_(open_session(plan_.participant_id, settings))
    {
    }

    SessionOutcome run()
    {
        outcome_.torn_bytes = files_.found.torn_bytes;
        outcome_.plan_remark = planned_.remark;
        started_ = now_started();
        try {
            take_up();
            if (is_over_) {
                keep_plan();
                finish();
                return outcome_;
            }
            if (!begin()) {
                files_.discard();
                return outcome_;
            }
        } catch (Aborted const& aborted) { // before anything of this part was recorded
            if (files_.is_new && record_.entries.empty()) files_.discard();
            outcome_.reason = aborted.what();
            return outcome_;
        } catch (...) {
            if (files_.is_new && record_.entries.empty()) files_.discard();
            throw;
        }
        carry_out();
        return outcome_;
    }

private:
    double unix_s() const { return settings_.unix_s ? settings_.unix_s() : machine_unix_s(); }

    std::string const& text_of(std::string const& text) const
    {
        auto const found = texts_.find(text);
        return found == texts_.end() ? text : found->second;
    }

    SessionStarted now_started() const
    {
        SessionStarted e;
        e.experiment = s_.id;
        e.participant_id = plan_.participant_id;
        e.participant = plan_.participant;
        e.session = settings_.session;
        e.version = settings_.version;
        e.git_hash = settings_.git_hash;
        e.script_sha256 = gi::sha256(settings_.script_text);
        e.plan_sha256 = gi::sha256(planned_.table);
        e.seed = s_.seed;
        if (!s_.participants.consent.empty()) e.consent_sha256 = gi::sha256(text_of(s_.participants.consent));
        e.is_simulated = settings_.is_simulated;
        return e;
    }

    /// Restores the state from the journal's earlier parts.
    void take_up()
    {
        if (files_.found.record.entries.empty()) return;
        auto const file = files_.folder / "journal.jsonl";
        check_record(files_.found.record, started_, file);
        int number = 0;
        for (JournalEntry& entry : files_.found.record.entries) {
            ++number;
            try {
                progress_.apply(entry);
            } catch (std::invalid_argument const& e) {
                throw ScriptError(file.string(), {number, 1}, "the journal does not follow its plan", e.what(),
                                  "restore it from a copy, nothing of it has been changed, or resume it with the "
                                  "version that wrote it");
            }
            if (auto const* const before = std::get_if<SessionStarted>(&entry)) {
                started_.part = before->part + 1;
                started_.consent_sha256 = before->consent_sha256;
            }
            auto const* const ended = std::get_if<SessionEnded>(&entry);
            is_over_ = ended != nullptr && ended->is_complete;
        }
        if (auto const last = last_unix_time(files_.found.record)) started_.gap_s = unix_s() - *last;
        outcome_.folder = files_.folder;
        outcome_.is_complete = is_over_;
        record_ = std::move(files_.found.record);
    }

    /// @return false if the participant does not consent
    bool begin()
    {
        CalibrationDone const calibration = call([&] { return p_.calibrate(s_.timing); });
        if (!calibration.passed && s_.timing.vsync == Vsync::required)
            throw ScriptError(s_.file, {}, "the display does not pass the test that the script requires",
                              calibration.reason, "fix it, or write timing: {vsync: record} to run anyway");
        bool const is_first = record_.entries.empty();
        if (is_first && !s_.participants.consent.empty() &&
            !call([&] { return p_.ask_consent(text_of(s_.participants.consent)); })) {
            outcome_.reason = "the participant did not consent; nothing is recorded";
            return false;
        }
        keep_plan();
        outcome_.folder = files_.folder;
        started_.about = settings_.about;
        for (auto& item : p_.about()) started_.about.push_back(std::move(item));
        started_.clock_s = p_.now();
        started_.utc = utc_text(unix_s());
        clock_offset_s_ = unix_s() - started_.clock_s;
        keep(started_);
        if (outcome_.torn_bytes > 0)
            note("warning", fmt::format("{} bytes of an incomplete line were cut off the journal's end",
                                        outcome_.torn_bytes));
        if (!planned_.remark.empty()) note("warning", planned_.remark);
        if (int const n = progress_.levels_not_due(); n > 0)
            note("warning", fmt::format("{} trials have other levels than this version's procedures choose; the "
                                        "recorded ones count",
                                        n));
        if (started_.gap_s < 0)
            note("clock_changed", fmt::format("by the wall clock this part begins {:.3f} s before the end of "
                                              "the previous part",
                                              -started_.gap_s));
        keep(calibration);
        write_summary();
        return true;
    }

    void carry_out()
    {
        std::string reason;
        is_under_way_ = true;
        try {
            if (!s_.participants.ask.empty() && !progress_.was_asked()) ask_participant();
            for (auto due = progress_.next(); due; due = progress_.next())
                if (between_steps())
                    skip(*due);
                else
                    perform(*due);
        } catch (DisplayLost const& lost) {
            reason = lost.why;
            note("display_lost", lost.why);
        } catch (Aborted const& aborted) {
            reason = aborted.what();
            for (NoteTaken const& taken : p_.notes()) keep(taken);
            note("abort", "");
        }
        end(reason);
    }

    void ask_participant()
    {
        ParticipantAsked const asked = call([&] { return p_.ask_participant(s_.participants.ask); });
        keep(asked);
        for (AskedQuestion const& q : s_.participants.ask)
            for (auto const& [id, answer] : asked.answers)
                if (std::string const flaw = flaw_of_answer(q, answer); id == q.id && !flaw.empty())
                    note("warning", fmt::format("the answer to '{}' is '{}': {}", id, answer, flaw));
    }

    /// Handles notes, experimenter commands and clocks. @return true if the next step is to be skipped
    bool between_steps()
    {
        for (NoteTaken const& taken : call([&] { return p_.notes(); })) keep(taken);
        double const offset_s = unix_s() - p_.now();
        if (std::abs(offset_s - clock_offset_s_) > kClockJump_s)
            note("clock_changed",
                 fmt::format("the wall clock jumped by {:+.3f} s; times are of the monotonic clock, which did not",
                             offset_s - clock_offset_s_));
        clock_offset_s_ = offset_s;
        switch (call([&] { return p_.action(); })) {
        case ExperimenterAction::pause:
            note("pause", "");
            call([&] { return p_.rest("Pause", 0, -1); });
            note("resume", "");
            return false;
        case ExperimenterAction::abort:
            throw Aborted();
        case ExperimenterAction::skip:
            return true;
        case ExperimenterAction::go_on:
            break;
        }
        return false;
    }

    void skip(NextStep const& due)
    {
        note("skip", fmt::format("step {}", due.step + 1));
        bool const is_trial = step(due).kind == PlanStepKind::trial && !due.is_questionnaire_of_trial;
        if (is_trial) {
            TrialDone trial;
            trial.step = due.step;
            trial.attempt = due.attempt;
            trial.is_valid = false;
            trial.reason = "skipped";
            ++outcome_.bad_trials;
            keep(trial);
        } else {
            keep(StepDone{due.step, p_.now(), p_.now(), "skipped"});
        }
    }

    PlanStep const& step(NextStep const& due) const { return plan_.steps[std::size_t(due.step)]; }

    void perform(NextStep const& due)
    {
        PlanStep const& at = step(due);
        switch (at.kind) {
        case PlanStepKind::instructions:
            keep_step(due, call([&] { return p_.instruct(text_of(at.text), due.step); }));
            break;
        case PlanStepKind::rest:
            keep_step(due, call([&] { return p_.rest(text_of(at.text), at.seconds, due.step); }));
            break;
        case PlanStepKind::free_walk:
            keep_step(due, call([&] { return p_.walk(request(due), text_of(at.text), at.seconds); }));
            break;
        case PlanStepKind::questionnaire:
            ask(due, at.questionnaire);
            break;
        case PlanStepKind::trial:
            perform_trial(due);
        }
    }

    void perform_trial(NextStep const& due)
    {
        Block const& block = s_.blocks[std::size_t(step(due).block)];
        if (due.is_questionnaire_of_trial)
            ask(due, block.questionnaire);
        else if (block.task == Task::free_walk)
            keep_step(due, call([&] { return p_.walk(request(due), block.prompt, block.duration_s); }));
        else
            show(due);
    }

    void keep_step(NextStep const& due, StepDone done)
    {
        if (done.reason == "aborted") throw Aborted();
        done.step = due.step;
        keep(done);
    }

    void ask(NextStep const& due, int questionnaire)
    {
        Questionnaire const& asked = s_.questionnaires[std::size_t(questionnaire)];
        QuestionnaireRequest const r{&asked, due.step, items_answered(due.step), [&](ItemAnswered item) {
                                         item.step = due.step;
                                         keep(item);
                                     }};
        QuestionnaireDone done = call([&] { return p_.ask(r); });
        done.step = due.step;
        done.answers.resize(asked.items.size());
        if (has_text_items(asked)) done.texts.resize(asked.items.size());
        keep(done);
    }

    /// Items of the step's questionnaire that were answered before an interruption.
    std::vector<ItemAnswered> items_answered(int step) const
    {
        std::vector<ItemAnswered> given;
        for (JournalEntry const& entry : record_.entries) {
            if (auto const* const item = std::get_if<ItemAnswered>(&entry); item && item->step == step)
                given.push_back(*item);
            auto const* const done = std::get_if<QuestionnaireDone>(&entry);
            if (done && done->step == step) given.clear();
        }
        return given;
    }

    TrialRequest request(NextStep const& due) const { return request_of(s_, plan_, progress_, due); }

    void show(NextStep const& due)
    {
        TrialRequest const r = request(due);
        double const total = watch_.ms(), synced = files_.journal.synced_ms() - synced_before_;
        if (has_shown_) {
            outcome_.bookkeeping_ms.push_back(total);
            outcome_.unsynced_ms.push_back(total - synced);
        }
        TrialDone done = call([&] { return p_.show(r); });
        watch_.restart();
        synced_before_ = files_.journal.synced_ms();
        if (!done.is_valid && done.reason == "aborted") throw Aborted();
        done.bookkeeping_ms = has_shown_ ? total : 0;
        has_shown_ = true;
        complete(s_, plan_, due, done);
        ++(done.is_valid ? outcome_.trials : outcome_.bad_trials);
        keep(done);
    }

    void keep(JournalEntry const& entry)
    {
        files_.journal.append(entry);
        progress_.apply(entry);
        record_.entries.push_back(entry);
        outcome_.steps +=
            std::holds_alternative<StepDone>(entry) || std::holds_alternative<QuestionnaireDone>(entry);
        if (settings_.on_kept) settings_.on_kept(entry);
    }
    void note(std::string const& kind, std::string const& text) { keep(NoteTaken{p_.now(), kind, text}); }

    /// Writes plan.tsv if it is missing.
    void keep_plan() const
    {
        auto const file = files_.folder / "plan.tsv";
        std::error_code ignored;
        if (!std::filesystem::exists(file, ignored)) gi::write_durably(file, planned_.table);
    }
    void write_summary() const { gi::write_durably(files_.folder / "session.json", session_summary(record_)); }

    /// Updates the files that depend on the whole journal, even if the process was
    /// killed before it did so the last time.
    void finish() const
    {
        std::string const summary = session_summary(record_);
        auto const file = files_.folder / "session.json";
        std::error_code ignored;
        if (!std::filesystem::exists(file, ignored) || gi::read_text(file) != summary)
            gi::write_durably(file, summary);
    }

    void end(std::string const& reason)
    {
        outcome_.is_complete = reason.empty();
        outcome_.reason = reason;
        for (NoteTaken const& taken : p_.notes()) keep(taken);
        keep(SessionEnded{p_.now(), utc_text(unix_s()), outcome_.is_complete, reason});
        finish();
    }

    /// Pauses the watch: the participant's time does not count as bookkeeping.
    template <class Call>
    auto call(Call const& presenter_call) -> decltype(presenter_call())
    {
        Stopwatch::Pause const pause(watch_);
        try {
            return presenter_call();
        } catch (Aborted const&) {
            throw;
        } catch (std::exception const& e) {
            if (!is_under_way_) throw;
            throw DisplayLost{e.what()};
        }
    }

    Script const& s_;
    Presenter& p_;
    SessionSettings const& settings_;
    SessionPlan planned_;
    Plan const& plan_;                         ///< of planned_
    std::map<std::string, std::string> texts_; ///< by file name
    Progress progress_;
    SessionFiles files_;
    SessionStarted started_;
    SessionRecord record_;
    SessionOutcome outcome_;
    Stopwatch watch_;
    double synced_before_ = 0, clock_offset_s_ = 0;
    bool is_over_ = false, is_under_way_ = false, has_shown_ = false;
};

} // namespace

SessionOutcome run_session(Script const& script, int participant, Presenter& presenter,
                           SessionSettings const& settings)
{
    return Session(script, participant, presenter, settings).run();
}

} // namespace study
