#pragma once
// The loop that every method renders in: pass after pass until the paths, the time or the error that was asked
// for, or an interruption; with progress, checkpoints and the losses of all paths.

#include "gi/render/accumulator.h"
#include "gi/render/render_settings.h"

#include <algorithm>
#include <chrono>
#include <functional>

namespace gi {

class PassLoop {
public:
    /// Time counts from here on: make it before the structures that the method builds.
    /// @param spent_s  on them already
    PassLoop(RenderSettings const& settings, StopRequest const& stop, RenderProgress const& progress,
             Report& report, double spent_s = 0);

    /// Traces that many more paths for every pixel, into the sums. The next one has the number first_path() plus
    /// those that the sums have.
    using Pass = std::function<void(Accumulator&, std::uint32_t paths)>;

    /// Everything of the result but picture and rays. Runs the passes in an arena of settings.threads.
    /// @param print see fingerprint.h; only read where there is a checkpoint
    /// Throws InputError if the checkpoint does not belong to this render.
    RenderResult run(std::uint64_t print, Pass const& pass);

    bool keeps_state() const { return !settings_.checkpoint.empty(); }
    Accumulator const& sums() const { return sums_; }
    std::uint32_t first_path() const { return settings_.share.first; }

private:
    using Clock = std::chrono::steady_clock;

    double seconds_since(Clock::time_point start) const
    {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
    bool save(std::uint64_t print);
    std::uint32_t next_pass(double seconds_per_path) const;
    std::uint32_t limit() const { return std::min(settings_.paths, settings_.share.count); }

    RenderSettings const& settings_;
    StopRequest const& stop_;
    RenderProgress const& progress_;
    Report& report_;
    Accumulator sums_;
    Clock::time_point start_;
};

} // namespace gi
