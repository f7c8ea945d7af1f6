#pragma once
#include "gi/core/progress.h"
#include "gi/core/report.h"

#include <string>

namespace viewer {

/// The experimenter's window: how far a session is, pause, skip, abort, notes. It asks the session's socket five
/// times a second, and ends with the session, its window, or the stop. Throws InputError where nobody listens.
/// @param where  as RemoteClient: a path, or the digits of a port of this machine
void run_control_window(std::string const& where, gi::StopRequest const& stop, gi::Report& report);

} // namespace viewer
