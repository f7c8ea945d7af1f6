#pragma once
// Tables of all sessions for other programs: R, databases, spreadsheets.

#include "study/tables/recorded_session.h"
#include "study/tables/table.h"

#include <filesystem>

namespace study {

struct NamedTable {
    std::string name; ///< a word
    Table table;
};

/// trials (one row each, one column per factor), stimuli, questionnaires, session_events, participants; all except
/// the last begin with the columns participant, session, simulated.
std::vector<NamedTable> export_tables(Script const& script, std::vector<RecordedSession> const& sessions);

/// Files in the layout of Psych-DS (https://psych-ds.github.io): data/study-ID_description-NAME_data.csv,
/// dataset_description.json with every column, and analysis.R and analysis.py, which fit mixed models to them.
/// Missing values are NA in these files.
std::vector<TextFile> export_files(Script const& script, std::vector<NamedTable> const& tables);
/// The text of analysis.R: a model for each block, by its task.
/// @param trials_file relative to the script's folder
std::string lme4_script(Script const& script, std::string const& trials_file);
/// The text of analysis.py: the same models with statsmodels, as far as it has them.
std::string statsmodels_script(Script const& script, std::string const& trials_file);

/// @throws ScriptError if the file exists and is not an SQLite database,
/// so that a wrong file name destroys nothing
void check_may_become_sqlite(std::filesystem::path const& file);
/// Writes a database with these tables to `file`, which must not exist. Columns whose cells are all numbers are
/// numeric, missing values are NULL. @throws std::runtime_error with SQLite's message
void write_sqlite(std::filesystem::path const& file, std::vector<NamedTable> const& tables);

} // namespace study
