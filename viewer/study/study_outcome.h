#pragma once
// What is left of a session of an experiment: its tables, and what it came to.

#include "study/run/session.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace viewer {

/// The tables of a data set made anew from its journals, and the script kept beside them, after a session. Where
/// that cannot be (records of another script), says so on stderr: the journals are the truth, and study rebuild
/// goes on.
void keep_tables(std::filesystem::path const& dir, std::string const& script_file);
/// What a session came to, as JSON and for people.
nlohmann::ordered_json session_json(std::string const& id, study::SessionOutcome const& outcome);
void print_session(std::string const& id, study::SessionOutcome const& outcome);

} // namespace viewer
