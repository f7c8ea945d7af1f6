#pragma once
// GLX_OML_sync_control of the current drawable; keeps Xlib's macros out of this header.

#include <cstdint>
#include <optional>

namespace viewer {

struct SwapCount {
    std::int64_t time_us = 0; ///< UST: of the last vertical blank, on a clock of the driver's choice
    std::int64_t swaps = 0;   ///< SBC: swaps since the window was created
};

/// True if a GLX context is current and its display lists the extension; a function pointer alone is no proof.
bool sync_control_listed();
/// glXGetSyncValuesOML; none if it fails.
std::optional<SwapCount> swaps_so_far();
/// glXWaitForSbcOML for all swaps so far; none if it fails.
std::optional<SwapCount> wait_for_swaps();

} // namespace viewer
