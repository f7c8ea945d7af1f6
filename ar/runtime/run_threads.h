#pragma once
// The two threads of a run that work ahead of the caller's: one takes frames and finds the camera, one adds what
// is virtual.

#include "ar/runtime/frame_clock.h"
#include "ar/runtime/hand_over.h"
#include "ar/runtime/runner.h"
#include "gi/core/error.h"

#include <exception>
#include <thread>

namespace viewer {

/// A frame on its way through the threads.
struct FrameInFlight {
    ar::Frame frame;   ///< once the camera is found, without the bytes that belong to a device
    double time_s = 0; ///< since the first
    double read_ms = 0;
    std::uint64_t overtaken = 0; ///< frames that it took the place of
    ArResult result;
};

class RunThreads {
public:
    /// All that is referred to outlives it; the source and the pipeline are its own meanwhile.
    /// @param is_timed     frames come at their own pace: newer ones overtake
    RunThreads(ar::FrameSource& source, ArPipeline& pipeline, ArRunOptions const& options, bool is_timed,
               FrameClock const& clock, gi::Report& report);
    ~RunThreads() { end(); }
    RunThreads(RunThreads const&) = delete;
    RunThreads& operator=(RunThreads const&) = delete;

    std::optional<FrameInFlight> next(std::chrono::milliseconds wait) { return done_.take(wait); }
    bool has_ended() const { return done_.has_ended(); }
    /// What is on its way is given up.
    void end();
    /// The source's state and all counts.
    void tell(ArSummary& summary) const;
    /// After the end: what a thread threw.
    void rethrow() const;

private:
    void guarded(std::function<void()> const& work, HandOver<FrameInFlight>& filled);
    void hand_over(FrameInFlight w, HandOver<FrameInFlight>& to);
    void find_all();
    ArResult found_in(FrameInFlight const& w);
    void add_all();
    void refuse(gi::InputError const& e);

    ar::FrameSource& source_;
    ArPipeline& pipeline_;
    ArRunOptions const& options_;
    bool is_timed_;
    FrameClock clock_;
    gi::Report& report_;
    gi::StopRequest ending_;
    HandOver<FrameInFlight> found_, done_;

    mutable std::mutex mutex_; // of what follows
    ar::SourceCounts counts_;
    ar::SourceState state_;
    std::uint64_t refused_ = 0, overtaken_ = 0;
    std::exception_ptr problem_;
    std::thread finder_, adder_;
};

} // namespace viewer
