#pragma once
#include "gi/core/progress.h"

#include <functional>

namespace bindings {

/// Runs long work on a separate thread without the GIL while the calling thread checks for signals. On Ctrl-C it
/// requests the work to stop, and throws KeyboardInterrupt when the work has ended. Call it with the GIL held.
/// @param tick  called regularly with the GIL held; an exception that it raises also stops the work; may be empty
/// Rethrows exceptions of the work.
void run_interruptible(std::function<void(gi::StopRequest const&)> const& work,
                       std::function<void()> const& tick = {});

} // namespace bindings
