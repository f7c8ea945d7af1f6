#pragma once
// The tables of one session: trials of each block, their stimuli, questionnaires, session events.

#include "study/tables/recorded_session.h"
#include "study/tables/table.h"

namespace study {

/// Column names for the factors of a script, in its order: the factor's name, or "factor_" + name if another
/// column of any table has this name.
std::vector<std::string> factor_columns(Script const& script);

/// One row per trial of a block that ran to its end, including practice and invalid ones. Onsets are in seconds
/// since the beginning of the session.
Table events_table(Script const& script, std::vector<TrialRow> const& rows, int block);
/// One row per stimulus shown in these trials.
Table stimuli_table(Script const& script, std::vector<TrialRow> const& rows, int block);
/// One row per sound that was due in these trials.
Table sounds_table(Script const& script, std::vector<TrialRow> const& rows, int block);
/// One row per item, then one per score, for each time that a questionnaire was answered.
Table questionnaires_table(Script const& script, RecordedSession const& session);
/// Session events: starts, calibrations, instructions, rests, walks, notes, ends.
Table session_events_table(RecordedSession const& session);

/// An answered questionnaire, with its step, which has the factors fixed at that time.
struct AnsweredQuestionnaire {
    Questionnaire const* questionnaire;
    PlanStep const* step;
    QuestionnaireDone const* done;
    int time_point; ///< from 1: the n-th time that this questionnaire was answered in the session
    double offset_s;
    QuestionnaireScores scores;

    /// Name of the factor's level that was fixed then; empty = none.
    std::string level(Script const& script, std::size_t factor) const;
    std::string condition(Script const& script) const; ///< all these levels: "cornell, exact"
};
/// @throws ScriptError if the journal has answers that the questionnaire does not allow
std::vector<AnsweredQuestionnaire> answered_questionnaires(Script const& script, RecordedSession const& session);

} // namespace study
