#pragma once
#include "gi/core/progress.h"

namespace viewer {

inline constexpr int kInterrupted = 130; ///< exit code after Ctrl-C or SIGTERM

/// While this object lives, Ctrl-C and SIGTERM request a stop; a second signal ends the program at once.
class InterruptGuard {
public:
    explicit InterruptGuard(gi::StopRequest& stop);
    ~InterruptGuard();
    InterruptGuard(InterruptGuard const&) = delete;
    InterruptGuard& operator=(InterruptGuard const&) = delete;
};

} // namespace viewer
