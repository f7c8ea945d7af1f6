#pragma once
// Measures when a frame was swapped, as accurately as the display allows.
//
// If GLX_OML_sync_control works (the extension is listed, glXWaitForSbcOML returns true and the swap count
// increases), the driver reports the time. Otherwise a fence follows the swap, and the time lies between the call
// and the fence; the later scan-out time is unknown, so one refresh of the monitor is added to the uncertainty.

#include "viewer/devices/gl/window.h"

#include <chrono>

namespace viewer {

enum class GlSwapMethod {
    sync_control, ///< glXWaitForSbcOML
    fence         ///< swap + glClientWaitSync
};

struct SwapTime {
    using Clock = std::chrono::steady_clock;
    Clock::time_point time; ///< best estimate
    /// When the program noticed the swap; regular intervals if swaps wait for the display.
    Clock::time_point seen;
    double uncertainty_ms = 0; ///< the swap took place within time +- this
    GlSwapMethod method = GlSwapMethod::fence;
};

class SwapTimer {
public:
    /// The window must outlive it. A failure of sync control is counted in the report, once.
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
