#pragma once
// The two threads of a run that work ahead of the caller's: one takes frames and estimates the camera pose, one
// adds the virtual objects.

#include "ar/runtime/frame_clock.h"
#include "ar/runtime/hand_over.h"
#include "ar/runtime/runner.h"
#include "gi/core/error.h"

#include <exception>
#include <thread>

namespace ar {

/// A frame that is being processed.
struct FrameInFlight {
    Frame frame;       ///< after the pose estimation, without bytes in device memory
    double time_s = 0; ///< since the first
    double read_ms = 0;
    std::uint64_t overtaken = 0; ///< number of frames that it replaced
    FrameResult result;
};

class RunThreads {
public:
    /// All referenced arguments must outlive it; only its threads may use the source and the pipeline.
    /// @param is_timed     frames come at their own pace, and newer ones replace waiting ones
    RunThreads(FrameSource& source, Pipeline& pipeline, RunOptions const& options, bool is_timed,
               FrameClock const& clock, gi::Report& report);
    ~RunThreads() { end(); }
    RunThreads(RunThreads const&) = delete;
    RunThreads& operator=(RunThreads const&) = delete;

    std::optional<FrameInFlight> next(std::chrono::milliseconds wait) { return done_.take(wait); }
    bool has_ended() const { return done_.has_ended(); }
    /// Stops and discards frames in progress.
    void end();
    /// Fills in the source's state and all counts.
    void tell(RunSummary& summary) const;
    /// Call after the end: rethrows a thread's exception.
    void rethrow() const;

private:
    void guarded(std::function<void()> const& work, HandOver<FrameInFlight>& filled);
    void hand_over(FrameInFlight w, HandOver<FrameInFlight>& to);
    void find_all();
    FrameResult found_in(FrameInFlight const& w);
    void add_all();
    void refuse(gi::InputError const& e);

    FrameSource& source_;
    Pipeline& pipeline_;
    RunOptions const& options_;
    bool is_timed_;
    FrameClock clock_;
    gi::Report& report_;
    gi::StopRequest ending_;
    HandOver<FrameInFlight> found_, done_;

    mutable std::mutex mutex_; // guards the members below
    SourceCounts counts_;
    SourceState state_;
    std::uint64_t refused_ = 0, overtaken_ = 0;
    std::exception_ptr problem_;
    std::thread finder_, adder_;
};

} // namespace ar
