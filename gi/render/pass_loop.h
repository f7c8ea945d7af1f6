#pragma once
// The render loop of every method: runs passes until the requested paths, time or error is reached or the render
// is interrupted; handles progress, checkpoints and the report of losses.

#include "gi/kernel/device_work.h"
#include "gi/render/accumulator.h"
#include "gi/render/render_settings.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>

namespace gi {

class PassLoop {
public:
    /// Starts the clock: construct it before building the method's structures.
    /// @param spent_s  seconds already spent on them
    PassLoop(RenderSettings const& settings, StopRequest const& stop, RenderProgress const& progress,
             Report& report, double spent_s = 0);

    /// Continues from the checkpoint, if the settings say so and it exists; run() does that if nobody did before.
    /// @param print  see fingerprint.h; only used with a checkpoint
    /// @throws InputError if the checkpoint belongs to another render.
    void resume(std::uint64_t print);
    /// Number of the next path of every pixel.
    std::uint32_t next_path() const { return first_path() + sums_.paths; }

    /// Callback that traces `paths` more paths for every pixel and adds them to the sums.
    /// The first of them has the number first_path() plus the number of paths already in the sums.
    /// If it throws Interrupted after a stop request, what it added before is kept (also by TiledPass),
    /// and the render ends; where there is nothing, run() throws it.
    using Pass = std::function<void(Accumulator&, std::uint32_t paths)>;

    /// Runs the passes in an arena of settings.threads and fills in all of the result except picture and rays.
    /// @param print  as for resume(), whose errors it throws
    RenderResult run(std::uint64_t print, Pass const& pass);

    bool keeps_state() const { return !settings_.checkpoint.empty(); }
    Accumulator const& sums() const { return sums_; }
    /// Puts the picture into the result: its layers, or with RenderSettings::by_rows the sums that they are made
    /// of, and what saves their state. Call it last.
    void deliver(World const& world, RenderResult& result);
    std::uint32_t first_path() const { return settings_.share.first; }

private:
    using Clock = std::chrono::steady_clock;

    double seconds_since(Clock::time_point start) const
    {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
    void announce_state();
    void report_device(DeviceWork const& before, double paths);
    bool save(std::uint64_t print);
    bool is_checkpoint_due() const;
    std::uint32_t next_pass(double seconds_per_path) const;
    std::uint32_t limit() const { return std::min(settings_.paths, settings_.share.count); }

    RenderSettings const& settings_;
    StopRequest const& stop_;
    RenderProgress const& progress_;
    Report& report_;
    Accumulator sums_;
    Clock::time_point start_, saved_{}; ///< saved_: end of the last checkpoint, or the start of the passes
    double checkpoints_s_ = 0, last_checkpoint_s_ = 0; ///< time taken by all and by the last
    bool is_announced_ = false;
    std::uint64_t print_ = 0; ///< of the state that deliver() leaves to be saved
    bool is_resumed_ = false; ///< resume() was called
};

} // namespace gi
