#pragma once
#include "study/observers/observer.h"
#include "study/tables/recorded_session.h"

namespace study {

/// One participant's session in memory, as simulate_session would record it: the same answers, without files and
/// waiting. @throws ScriptError if a procedure cannot be run
RecordedSession simulated_record(Script const& script, Plan plan, Observer const& observer);

} // namespace study
