#pragma once
// When a frame was swapped, as well as this display can tell.
//
// Where GLX_OML_sync_control works - the extension is listed, glXWaitForSbcOML returns true and the count of swaps
// goes on - the driver tells when. Elsewhere the swap is followed by a fence, and the time lies between the call
// and the fence; when the pixels were scanned out after it nobody says, so that a refresh of the monitor is added
// to the uncertainty.

#include "viewer/devices/gl/window.h"

#include <chrono>

namespace viewer {

enum class GlSwapMethod {
    sync_control, ///< glXWaitForSbcOML
    fence         ///< swap + glClientWaitSync
};

struct SwapTime {
    using Clock = std::chrono::steady_clock;
    Clock::time_point time; ///< best guess
    Clock::time_point
        seen; ///< when it was known to be done: intervals of swaps that wait for the display keep time
    double uncertainty_ms = 0; ///< the swap took place within time +- this
    GlSwapMethod method = GlSwapMethod::fence;
};

class SwapTimer {
public:
    /// The window must outlive it. What went wrong with sync control is counted in the report, once.
    SwapTimer(Window& window, gi::Report& report);
    /// Swaps and waits until it is done. The window's context must be current.
    SwapTime swap();

private:
    bool try_sync_control(SwapTime::Clock::time_point called, SwapTime& out);

    Window& window_;
    gi::Report& report_;
    bool sync_control_ = false;
    double refresh_ms_ = 0;
};

} // namespace viewer
