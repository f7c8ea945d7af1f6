#pragma once
// Trials that other programs recorded, as sessions of an experiment, so that they are analysed like own records.

#include "study/imported/delimited_text.h"
#include "study/tables/recorded_session.h"

#include <map>
#include <optional>

namespace study {

/// What a column of a table means.
struct ColumnRoles {
    /// Role -> column. Roles: participant, run, item, first, second, chosen, first_chosen, chosen_from_0, first_wins,
    /// second_wins, ties, value, level, signal, correct, yes, trials, correct_count, wrong_count, yes_count,
    /// no_count, percent, reaction_s, reaction_ms. participant and run may be several columns, "group+id", which together
    /// name one; `file` is the name of the row's file if no column is called so.
    std::map<std::string, std::string> column{};
    std::vector<std::string> factors{}; ///< columns with the conditions of a trial, or the groups of participants
    /// Column -> value: uses only rows with this text (such as without practice).
    std::vector<std::pair<std::string, std::string>> only{};
    std::optional<Task> task{};  ///< none = by the roles: pair, rating, 2ifc with levels, yes_no with signals
    Scale scale = Scale::linear; ///< of levels
    bool harder_up = false;      ///< higher levels are harder
    bool is_matrix = false;      ///< rows over columns: how often an item was chosen, items named by both
    std::string id{};            ///< of the experiment; empty = by the file's name
    /// Column -> what stands for a missing value in it; without a column in those of numbers and answers, not of names.
    std::vector<std::pair<std::string, std::string>> missing{};
};

/// "role=column, role=column". @throws ScriptError an unknown role, one that is given twice, no "="
std::map<std::string, std::string> parse_roles(std::string const& text);

struct ImportedTable {
    Script script;
    std::vector<RecordedSession> sessions; ///< one per participant, in the order of the table
    std::vector<std::string> notes;        ///< rows left out and why, what was concluded about factors and units
};

/// Participants without such a column are one person. Rows without a cell that the task needs are left out and
/// counted (other programs write rows for instructions too). Counts become single trials.
/// Numbers have decimal points or commas; which, is the same in all of a column of a file. Notes name what makes the table
/// doubtful (table_doubts.h).
/// @throws ScriptError unknown columns, two of one name, roles that do not fit together, cells that are no number or not 0 or 1,
/// counts that are not integers, an item compared with itself, with file:line:column
ImportedTable import_trials(DelimitedText const& table, ColumnRoles const& roles);

} // namespace study
