#pragma once
// How a model observer answers trials and questionnaires.

#include "study/observers/observer.h"
#include "study/run/presenter.h"

namespace study {

struct ModelAnswer {
    std::string response; ///< as in TrialDone
    std::optional<double> value;
};

/// Answer of a model observer to a trial: from the psychometric function if a setting is varied, otherwise by
/// comparing noisy percepts of the stimuli.
ModelAnswer answer(Observer const& observer, TrialRequest const& trial, Random& random);

/// Fills in the answers to the items of a questionnaire.
void answer_items(Observer const& observer, Questionnaire const& questionnaire, Random& random,
                  QuestionnaireDone& done);

} // namespace study
