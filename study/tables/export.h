#pragma once
// All sessions in tables for other programs: R, databases, spreadsheets.

#include "study/tables/recorded_session.h"
#include "study/tables/table.h"

#include <filesystem>

namespace study {

struct NamedTable {
    std::string name; ///< a word
    Table table;
};

/// trials (a row each, every factor a column), stimuli, questionnaires, happenings, participants; each but the
/// last with the columns participant, session, simulated in front.
std::vector<NamedTable> export_tables(Script const& script, std::vector<RecordedSession> const& sessions);

/// Files in the layout of Psych-DS (https://psych-ds.github.io): data/study-ID_description-NAME_data.csv,
/// dataset_description.json with every column, and analysis.R, which fits mixed models to them with lme4. Nothing
/// is NA in these files.
std::vector<TextFile> export_files(Script const& script, std::vector<NamedTable> const& tables);
/// The text of analysis.R: a model for each block, by its task.
/// @param trials_file relative to the script's folder
std::string lme4_script(Script const& script, std::string const& trials_file);

/// @throws ScriptError where the file is there and is no database (of SQLite): whoever names another file by
/// mistake does not lose it
void check_may_become_sqlite(std::filesystem::path const& file);
/// A database with these tables at `file`, which must not be there. Columns whose cells are all numbers are
/// numbers, nothing is NULL. @throws std::runtime_error with SQLite's message
void write_sqlite(std::filesystem::path const& file, std::vector<NamedTable> const& tables);

} // namespace study
