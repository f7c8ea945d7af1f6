#pragma once
#include "gi/core/progress.h"

namespace viewer {

inline constexpr int kInterrupted = 130; ///< exit code

/// While this lives, Ctrl-C and SIGTERM ask for a stop; a second one ends the program at once.
class InterruptGuard {
public:
    explicit InterruptGuard(gi::StopRequest& stop);
    ~InterruptGuard();
    InterruptGuard(InterruptGuard const&) = delete;
    InterruptGuard& operator=(InterruptGuard const&) = delete;
};

} // namespace viewer
