#pragma once
#include "gi/core/progress.h"

#include <functional>

namespace bindings {

/// Does long work on a thread of its own, without the interpreter's lock, while this one looks after signals: on
/// Ctrl-C the work is asked to stop, and KeyboardInterrupt goes on when it has. To be called with the lock.
/// @param tick  called with the lock now and then meanwhile; what it raises stops the work too; may be empty
/// Throws what the work throws.
void run_interruptible(std::function<void(gi::StopRequest const&)> const& work,
                       std::function<void()> const& tick = {});

} // namespace bindings
