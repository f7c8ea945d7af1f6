#pragma once
// Results of a session of an experiment: its tables and its outcome.

#include "study/run/session.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace viewer {

/// Rebuilds the tables of a data set from its journals after a session, and copies the script beside them. If that
/// fails (records of another script), prints a note on stderr: no data are lost, as study rebuild can make the
/// tables from the journals later.
void keep_tables(std::filesystem::path const& dir, std::string const& script_file);
/// Outcome of a session, as JSON and as readable text.
nlohmann::ordered_json session_json(std::string const& id, study::SessionOutcome const& outcome);
void print_session(std::string const& id, study::SessionOutcome const& outcome);

} // namespace viewer
