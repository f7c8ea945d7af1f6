#pragma once
// Forwards the steps of a session to a Python object (lightwell/study/_steps.py), which has one method for each
// method of study::Presenter and returns dicts.

#include "study/run/presenter.h"

#include <exception>
#include <functional>
#include <pybind11/pybind11.h>

namespace bindings {

namespace py = pybind11;

class PythonPresenter : public study::Presenter {
public:
    explicit PythonPresenter(py::object steps) : steps_(std::move(steps)) {}

    double now() const override;
    std::vector<std::pair<std::string, std::string>> about() const override;
    study::CalibrationDone calibrate(study::Timing const& timing) override;
    bool ask_consent(std::string const& markdown) override;
    study::ParticipantAsked ask_participant(std::vector<study::AskedQuestion> const& questions) override;
    study::StepDone instruct(std::string const& markdown, int step) override;
    study::StepDone rest(std::string const& prompt, double least_s, int step) override;
    study::StepDone walk(study::TrialRequest const& where, std::string const& prompt, double seconds) override;
    study::QuestionnaireDone ask(study::QuestionnaireRequest const& request) override;
    study::TrialDone show(study::TrialRequest const& trial) override;
    study::ExperimenterAction action() override;
    std::vector<study::NoteTaken> notes() override;

    /// Exception of a Python method, which ended the session; null = none.
    std::exception_ptr raised() const { return raised_; }

private:
    template <class Result>
    Result call(std::function<Result()> const& ask) const;

    py::object steps_;
    mutable std::exception_ptr raised_;
};

/// A trial, or the place of a walk, as a Python dict.
py::dict to_dict(study::TrialRequest const& request);

} // namespace bindings
