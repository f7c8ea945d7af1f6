#pragma once
// Simulates whole sessions with model observers, and keeps the true parameters beside the data.

#include "study/observers/observer.h"
#include "study/run/session.h"

namespace study {

/// File of the true parameters of simulated sessions: DIR/sourcedata/simulation/truth.json.
std::filesystem::path truth_file(std::filesystem::path const& dir);
/// @throws ScriptError if other model observers answered in this folder before
void keep_truth(std::filesystem::path const& dir, std::string const& truth);

/// Simulates one participant's whole session without waiting. Its recorded wall clock starts now and advances as
/// fast as for a person; a resumed session continues gap_s after its last entry.
/// @param settings unix_s and is_simulated are set here @throws ScriptError as run_session does
SessionOutcome simulate_session(Script const& script, int participant, Observer const& observer,
                                SessionSettings settings, double gap_s);

} // namespace study
