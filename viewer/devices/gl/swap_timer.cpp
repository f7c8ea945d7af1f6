#include "viewer/devices/gl/swap_timer.h"

#include "viewer/devices/gl/sync_control.h"

#include <epoxy/gl.h>

namespace viewer {
namespace {

using Clock = SwapTime::Clock;

double ms_between(Clock::time_point a, Clock::time_point b)
{
    return std::chrono::duration<double, std::milli>(b - a).count();
}

constexpr int kUnknownRefreshHz = 60; // assumed; slower than most monitors
constexpr GLuint64 kFence_ns = 1'000'000'000;

} // namespace

SwapTimer::SwapTimer(Window& window, gi::Report& report) : window_(window), report_(report)
{
    window_.gl().make_current();
    int const hz = window_.refresh_hz();
    refresh_ms_ = 1000.0 / (hz > 0 ? hz : kUnknownRefreshHz);
    sync_control_ = window_.gl().glx().context && sync_control_listed();
}

SwapTime SwapTimer::swap()
{
    SwapTime out;
    Clock::time_point const called = Clock::now();
    if (sync_control_) {
        if (try_sync_control(called, out)) return out;
        sync_control_ = false;
        report_.lose("windows whose GLX_OML_sync_control is listed but does not work", 1,
                     "glXWaitForSbcOML refused or did not count the swap");
    } else {
        window_.swap();
    }
    GLsync const fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    GLenum const reached = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kFence_ns);
    glDeleteSync(fence);
    Clock::time_point const done = Clock::now();
    if (reached != GL_ALREADY_SIGNALED && reached != GL_CONDITION_SATISFIED)
        report_.lose("buffer swaps whose fence was not reached within 1 s");
    out.method = GlSwapMethod::fence;
    out.time = called + (done - called) / 2;
    out.seen = done;
    out.uncertainty_ms = ms_between(called, done) / 2 + refresh_ms_;
    return out;
}

/// Always swaps.
bool SwapTimer::try_sync_control(Clock::time_point called, SwapTime& out)
{
    auto const before = swaps_so_far();
    window_.swap();
    auto const after = before ? wait_for_swaps() : std::nullopt;
    if (!after || after->swaps <= before->swaps) return false;
    Clock::time_point const done = Clock::now();
    // Mesa uses CLOCK_MONOTONIC, as steady_clock does; the extension does not specify a clock.
    Clock::time_point const told{std::chrono::microseconds(after->time_us)};
    out.method = GlSwapMethod::sync_control;
    if (told >= called && told <= done) {
        out.time = told;
        out.uncertainty_ms = ms_between(told, done);
    } else {
        out.time = called + (done - called) / 2;
        out.uncertainty_ms = ms_between(called, done) / 2;
    }
    out.seen = out.time;
    return true;
}

} // namespace viewer
