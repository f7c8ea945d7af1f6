#pragma once
// Parts of the analysis that do not belong to a single block.

#include "study/analysis/groups.h"

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

} // namespace study
