#pragma once
#include "gi/core/progress.h"
#include "gi/core/report.h"

#include <string>

namespace viewer {

/// The experimenter's window: progress of a session, pause, skip, abort, notes. Polls the session's socket five
/// times per second. Returns when the session ends, the window is closed, or stop is requested. Throws InputError
/// if no session listens. @param where  as in RemoteClient: a socket's path, or the digits of a local port
/// @param token_file  of a port; empty = where the session puts it
void run_control_window(std::string const& where, std::string const& token_file, gi::StopRequest const& stop,
                        gi::Report& report);

} // namespace viewer
