#pragma once
#include "study/observers/observer.h"
#include "study/run/presenter.h"

namespace study {

struct ModelAnswer {
    std::string response; ///< as in TrialDone
    std::optional<double> value;
};

/// What an observer answers to a trial: of what is varied by the psychometric function, otherwise by comparing
/// noisy percepts of the stimuli.
ModelAnswer answer(Observer const& observer, TrialRequest const& trial, Random& random);

/// Items of a questionnaire.
std::vector<std::optional<double>> answer_items(Observer const& observer, Questionnaire const& questionnaire,
                                                Random& random);

} // namespace study
