#pragma once
#include "study/observers/observer.h"
#include "study/run/session.h"

namespace study {

/// Where the truth of simulated sessions lies, beside their results: DIR/sourcedata/simulation/truth.json.
std::filesystem::path truth_file(std::filesystem::path const& dir);
/// @throws ScriptError where other observers answered in this folder before
void keep_truth(std::filesystem::path const& dir, std::string const& truth);

/// One participant's session from beginning to end, in a moment. By the wall clock it begins now and takes as long
/// as a person would; one that goes on does so gap_s after its last entry.
/// @param settings unix_s and is_simulated are set here @throws ScriptError as run_session does
SessionOutcome simulate_session(Script const& script, int participant, Observer const& observer,
                                SessionSettings settings, double gap_s);

} // namespace study
