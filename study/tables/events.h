#pragma once
// The tables of one session: trials of each block, the stimuli of these trials, questionnaires, everything else
// that happened.

#include "study/tables/recorded_session.h"
#include "study/tables/table.h"

namespace study {

/// Names of columns for the factors of a script, in its order: their own, or "factor_" + name where that is the
/// name of another column of any table.
std::vector<std::string> factor_columns(Script const& script);

/// A row per trial of a block that was carried through, practice and invalid ones too. Onsets are in seconds since
/// the beginning of the session.
Table events_table(Script const& script, std::vector<TrialRow> const& rows, int block);
/// A row per stimulus that was shown in these trials.
Table stimuli_table(Script const& script, std::vector<TrialRow> const& rows, int block);
/// A row per item, then one per score, of each questionnaire as often as it was answered.
Table questionnaires_table(Script const& script, RecordedSession const& session);
/// What was no trial: starts, calibrations, instructions, rests, walks, notes, ends.
Table happenings_table(RecordedSession const& session);

/// A questionnaire as it was answered, with what of the factors was fixed then.
struct AnsweredQuestionnaire {
    Questionnaire const* questionnaire;
    PlanStep const* step;
    QuestionnaireDone const* done;
    int time_point; ///< from 1: how often this questionnaire had come in this session
    double offset_s;
    QuestionnaireScores scores;
};
/// @throws ScriptError where the journal has answers that the questionnaire does not
std::vector<AnsweredQuestionnaire> answered_questionnaires(Script const& script, RecordedSession const& session);

} // namespace study
