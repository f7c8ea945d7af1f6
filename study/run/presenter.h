#pragma once
// Shows trials and collects the answers: a window, a wall, a headset, or a model observer.
// Session decides what is recorded, chosen and repeated; a presenter keeps no state between calls. Calls return
// when the participant is done, so a presenter processes its own events meanwhile; nothing is written to the disk
// during a call, except by QuestionnaireRequest::keep. An exception from a call (Aborted, or any other: the
// display was lost, ...) ends the session, and the step under way counts as not done.

#include "study/journal/entries.h"
#include "study/plan/plan.h"

#include <functional>
#include <stdexcept>
namespace study {

/// A fully specified trial of the plan.
struct TrialRequest {
    Script const* script = nullptr;
    Block const* block = nullptr;
    PlanStep const* step = nullptr;
    int step_index = 0, attempt = 1;
    std::vector<Stimulus> stimuli;           ///< of step->trial, with the levels that procedures chose
    std::optional<Stimulus> reference;       ///< also shown
    std::optional<double> level;             ///< of the varied setting
    int trials_done = 0, trials_planned = 0; ///< of the session, for progress displays
};

/// A questionnaire to be answered.
struct QuestionnaireRequest {
    Questionnaire const* questionnaire = nullptr;
    int step = 0;
    /// Answers given before the session was interrupted, in their order;
    /// the participant continues after the last one.
    std::vector<ItemAnswered> given{};
    /// Call it when the participant leaves an item, so that its answer is on the disk; a presenter that asks all
    /// items at once does not need it. Empty = there is no disk.
    std::function<void(ItemAnswered const&)> keep{};
};

/// The experimenter's command, which may come at any time.
enum class ExperimenterAction { go_on, pause, skip, abort };

/// Thrown from any call when the session is aborted during it. The reason,
/// recorded in session.json, states by whom.
struct Aborted : std::runtime_error {
    explicit Aborted(std::string const& reason = "aborted by the experimenter") : std::runtime_error(reason) {}
};

class Presenter {
public:
    virtual ~Presenter() = default;

    /// Seconds of a monotonic clock; all times of the presenter refer to it.
    virtual double now() const = 0;
    /// Provenance to record: device, driver, display.
    virtual std::vector<std::pair<std::string, std::string>> about() const = 0;
    virtual CalibrationDone calibrate(Timing const& timing) = 0;
    /// @return false if the participant does not consent
    virtual bool ask_consent(std::string const& markdown) = 0;
    /// Answers that flaw_of_answer() refuses are to be asked again.
    virtual ParticipantAsked ask_participant(std::vector<AskedQuestion> const& questions) = 0;
    virtual StepDone instruct(std::string const& markdown, int step) = 0;
    virtual StepDone rest(std::string const& prompt, double least_s, int step) = 0;
    virtual StepDone walk(TrialRequest const& where, std::string const& prompt, double seconds) = 0;
    virtual QuestionnaireDone ask(QuestionnaireRequest const& request) = 0;
    /// Runs a trial: iti, warm-up, stimuli, answer, feedback. Session fills in step, attempt, level, is_correct
    /// and bookkeeping_ms, and itself detects too many dropped frames and missing answers. A trial that the
    /// experimenter ends while it is shown is invalid, with the reason "skipped" (done; action() then returns
    /// go_on) or "aborted" (as if Aborted were thrown). A StepDone may have these reasons too.
    virtual TrialDone show(TrialRequest const& trial) = 0;
    /// The experimenter's command since the last call; called between steps.
    virtual ExperimenterAction action() = 0;
    virtual std::vector<NoteTaken> notes() = 0; ///< since the last call
};

} // namespace study
