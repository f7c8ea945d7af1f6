#pragma once
#include "study/observers/observer.h"
#include "study/run/presenter.h"

namespace study {

/// Presenter without display: simulates a display with a steady rate, a clock that advances by the duration of
/// each step, and an observer. Answers depend only on observer, step and attempt, so an interrupted and resumed
/// session has the same answers as an uninterrupted one.
class ModelPresenter : public Presenter {
public:
    explicit ModelPresenter(Observer observer) : observer_(std::move(observer)) {}

    double now() const override { return now_s_; }
    std::vector<std::pair<std::string, std::string>> about() const override;
    CalibrationDone calibrate(Timing const& timing) override;
    bool ask_consent(std::string const& markdown) override;
    ParticipantAsked ask_participant(std::vector<AskedQuestion> const& questions) override;
    StepDone instruct(std::string const& markdown, int step) override;
    StepDone rest(std::string const& prompt, double least_s, int step) override;
    StepDone walk(TrialRequest const& where, std::string const& prompt, double seconds) override;
    QuestionnaireDone ask(QuestionnaireRequest const& request) override;
    TrialDone show(TrialRequest const& trial) override;
    ExperimenterAction action() override { return ExperimenterAction::go_on; }
    std::vector<NoteTaken> notes() override { return {}; }

private:
    StepDone take(int step, double seconds);
    void play_cues(TrialRequest const& r, double start_s, TrialDone& done) const;
    void show_stimuli(TrialRequest const& trial, double reaction_s, Random& random, TrialDone& done);

    Observer observer_;
    double now_s_ = 0;
};

} // namespace study
