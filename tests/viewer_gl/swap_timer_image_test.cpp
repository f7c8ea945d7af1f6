// Swaps are timed on a real window; the method depends on the server and says itself.

#include "tests/viewer_gl/on_xvfb.h"
#include "viewer/devices/gl/swap_timer.h"
#include "viewer/devices/gl/sync_control.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <thread>

namespace viewer::test {
namespace {

using SwapOnX = OnXvfb;

TEST_F(SwapOnX, TimesAreOrderedAndBounded)
{
    WindowSettings settings;
    settings.size_px = {320, 240};
    settings.swap_interval = 0;
    Window window(settings, report);
    SwapTimer timer(window, report);
    std::vector<double> uncertainties;
    SwapTime last;
    for (int frame = 0; frame < 60; ++frame) {
        glClearColor(float(frame) / 60, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        auto const before = SwapTime::Clock::now();
        last = timer.swap();
        auto const after = SwapTime::Clock::now();
        auto const slack = std::chrono::duration<double, std::milli>(last.uncertainty_ms);
        EXPECT_GE(last.time + slack, before);
        EXPECT_LE(last.time - slack, after);
        EXPECT_GE(last.time, before);
        EXPECT_LE(last.time, after);
        EXPECT_GT(last.uncertainty_ms, 0);
        EXPECT_LT(last.uncertainty_ms, 1000);
        uncertainties.push_back(last.uncertainty_ms);
    }
    std::sort(uncertainties.begin(), uncertainties.end());
    std::cout << "sync control listed: " << sync_control_listed() << "; method "
              << (last.method == GlSwapMethod::fence ? "fence" : "sync_control") << ", uncertainty median "
              << uncertainties[30] << " ms, greatest " << uncertainties.back() << " ms; monitor "
              << window.refresh_hz() << " Hz\n";
    for (auto const& [what, loss] : report.losses()) std::cout << what << ": " << loss.first << "\n";
}

/// A counter that stands still, or none, is never taken for a time.
TEST_F(SwapOnX, SyncControlIsBelievedOnlyWhereItCounts)
{
    Window window(WindowSettings{}, report);
    SwapTimer timer(window, report);
    SwapTime const first = timer.swap();
    if (!sync_control_listed()) {
        EXPECT_EQ(first.method, GlSwapMethod::fence);
        return;
    }
    auto const before = swaps_so_far();
    window.swap();
    auto const after = wait_for_swaps();
    bool const counts = before && after && after->swaps > before->swaps;
    EXPECT_EQ(first.method == GlSwapMethod::sync_control, counts);
}

} // namespace
} // namespace viewer::test
