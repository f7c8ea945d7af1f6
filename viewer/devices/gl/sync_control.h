#pragma once
// GLX_OML_sync_control of the current drawable, without Xlib's macros in sight.

#include <cstdint>
#include <optional>

namespace viewer {

struct SwapCount {
    std::int64_t time_us = 0; ///< UST: of the last vertical blank, on a clock of the driver's choice
    std::int64_t swaps = 0;   ///< SBC: since the window was made
};

/// Whether a GLX context is current and its display lists the extension: a function pointer is no proof.
bool sync_control_listed();
/// glXGetSyncValuesOML; nothing where it refuses.
std::optional<SwapCount> swaps_so_far();
/// glXWaitForSbcOML for all swaps that were called; nothing where it refuses.
std::optional<SwapCount> wait_for_swaps();

} // namespace viewer
