#pragma once
// Stops work cleanly on Ctrl-C, SIGTERM and SIGHUP.

#include "gi/core/progress.h"

#include <csignal>

namespace viewer {

/// Exit code after an interruption: 128 + the signal that requested the last stop, as shells report it: 130
/// Ctrl-C, 143 SIGTERM, 129 a closed terminal (SIGHUP). 130 where another process of a cluster was interrupted.
int interrupted_code();
/// True once a signal requested a stop.
bool was_interrupted();

/// While this object lives, Ctrl-C, SIGTERM and a closed terminal (SIGHUP,
/// unless nohup ignores it) request a stop; a second Ctrl-C or SIGTERM ends the program at once.
/// SIGHUP often comes twice, from the kernel and the shell.
class InterruptGuard {
public:
    explicit InterruptGuard(gi::StopRequest& stop);
    ~InterruptGuard();
    InterruptGuard(InterruptGuard const&) = delete;
    InterruptGuard& operator=(InterruptGuard const&) = delete;

private:
    struct sigaction before_[3]; ///< of SIGINT, SIGTERM, SIGHUP
};

} // namespace viewer
