#pragma once
// What shows trials to somebody and takes the answers: a window, a wall, a headset, or a model observer.
// Everything that is kept, chosen or repeated is decided by Session; a presenter has no memory from one call to
// the next. Calls return when the participant is done, so that a presenter pumps its own events meanwhile; nothing
// is written to a disk while a call is under way. An exception out of a call ends the session, and what was under
// way counts as not done: Aborted, or any other (the display was lost, ...).

#include "study/journal/entries.h"
#include "study/plan/plan.h"

#include <stdexcept>
namespace study {

/// A trial of the plan with everything decided.
struct TrialRequest {
    Script const* script = nullptr;
    Block const* block = nullptr;
    PlanStep const* step = nullptr;
    int step_index = 0, attempt = 1;
    std::vector<Stimulus> stimuli;           ///< of step->trial, the levels that procedures choose filled in
    std::optional<Stimulus> reference;       ///< shown too
    std::optional<double> level;             ///< of what is varied
    int trials_done = 0, trials_planned = 0; ///< of the session, for who watches
};

/// The experimenter's wish, which may come at any time.
enum class ExperimenterAction { go_on, pause, skip, abort };

/// Thrown out of any call: somebody aborts while it is under way. The reason says who; it stands in session.json.
struct Aborted : std::runtime_error {
    explicit Aborted(std::string const& reason = "aborted by the experimenter") : std::runtime_error(reason) {}
};

class Presenter {
public:
    virtual ~Presenter() = default;

    /// Seconds of the monotonic clock in which all its times are.
    virtual double now() const = 0;
    /// What is worth keeping about device, driver, display.
    virtual std::vector<std::pair<std::string, std::string>> about() const = 0;
    virtual CalibrationDone calibrate(Timing const& timing) = 0;
    /// @return false where the participant does not agree
    virtual bool ask_consent(std::string const& markdown) = 0;
    virtual ParticipantAsked ask_participant(std::vector<std::string> const& questions) = 0;
    virtual StepDone instruct(std::string const& markdown, int step) = 0;
    virtual StepDone rest(std::string const& prompt, double least_s, int step) = 0;
    virtual StepDone walk(TrialRequest const& where, std::string const& prompt, double seconds) = 0;
    virtual QuestionnaireDone ask(Questionnaire const& questionnaire, int step) = 0;
    /// Iti, warm-up, stimuli, answer, feedback. Session fills in step, attempt, level, is_correct and
    /// bookkeeping_ms, and finds too many dropped frames and missing answers itself. A trial that the experimenter
    /// ends while it is shown is not valid, with the reason "skipped" (done; wish() then says go_on) or "aborted"
    /// (as if Aborted were thrown). A StepDone may have these reasons too.
    virtual TrialDone show(TrialRequest const& trial) = 0;
    /// Since the last call; asked between steps.
    virtual ExperimenterAction action() = 0;
    virtual std::vector<NoteTaken> notes() = 0; ///< since the last call
};

} // namespace study
