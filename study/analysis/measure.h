#pragma once
// Numbers per observer and condition: what tests of groups and conditions start from.

#include "study/analysis/groups.h"

#include <string>
#include <vector>

namespace study {

/// What conditions differ in: a factor, the judged item, the time.
struct MeasureAxis {
    std::string name;
    std::vector<std::string> levels;
};

/// One number of one observer in one condition.
struct Observation {
    std::string participant;
    std::vector<int> levels; ///< by axis
    double value = kUnknown;
};

struct Measure {
    std::string block, name; ///< name: "rating", "d'"
    std::vector<MeasureAxis> axes;
    std::vector<Observation> observations;
    int relative_to = -1; ///< axis over which each observer's numbers have the mean 0 by definition; -1 = none
};

/// A factor between participants, with the level of each of them.
struct ParticipantFactor {
    std::string name;
    std::vector<std::string> levels;
    std::map<std::string, int> level; ///< by participant
};

/// Factors with method `between` whose level differs between these sessions.
std::vector<ParticipantFactor> participant_factors(Script const& script,
                                                   std::vector<RecordedSession const*> const& sessions);

/// Judgements (logarithms of magnitudes), proportions correct and d', JOD of each observer, ranks, thresholds:
/// what the task of the block measures.
std::vector<Measure> measures_of(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                                 BlockResult const& result);
/// Scores of questionnaires, by time or by the condition in which they were answered.
std::vector<Measure> questionnaire_measures(Script const& script,
                                            std::vector<RecordedSession const*> const& sessions);

} // namespace study
