#pragma once
// Parts of the analysis that do not belong to a single block.

#include "study/analysis/groups.h"
#include "study/analysis/measure.h"

namespace study {

/// Adds a session's counts to its participant's summary; creates the summary if missing.
void summarise(RecordedSession const& session, SessionStarted const& start, std::vector<TrialRow> const& rows,
               Analysis& analysis);
/// Side bias, reaction times, and the exclusions of a participant.
void finish_summary(ObserverTrials const& observer, AnalysisSettings const& settings, ObserverSummary& summary,
                    Analysis& analysis);

void analyze_questionnaires(Script const& script, std::vector<RecordedSession const*> const& sessions,
                            AnalysisSettings const& settings, Analysis& analysis);
void analyze_timing(Script const& script, std::vector<ObserverTrials> const& observers,
                    std::vector<RecordedSession const*> const& sessions, Analysis& analysis);
void analyze_transitions(Script const& script, std::vector<RecordedSession const*> const& sessions,
                         Analysis& analysis);
/// The factors that vary between the counted trials of these observers, in the order of the script.
/// @param groups  from participant_factors
std::vector<FactorUse> factor_use(Script const& script, std::vector<ObserverTrials> const& observers,
                                  std::vector<ParticipantFactor> const& groups);
/// Tests effects of conditions and of groups of participants on a measure: an analysis of variance of observers'
/// means (mixed_anova.h) if there is something to compare, and Welch's tests between groups in each condition and
/// over all. Observers without one of the cells are left out of the former, with a note.
void test_effects(Measure const& measure, std::vector<ParticipantFactor> const& groups,
                  AnalysisSettings const& settings, Analysis& analysis);

} // namespace study
