#pragma once
// Computes composites for a headset in a separate thread, from one camera for both eyes, or one for each. With
// two, the left camera's pose is estimated from its frame, and the right one's follows from its mounting; both are
// composited for the same moment of the same world.

#include "ar/capture/frame_source.h"
#include "ar/runtime/runner.h"
#include "gi/core/progress.h"

#include <atomic>
#include <mutex>
#include <thread>

namespace viewer {

struct PassThroughOptions {
    int frames = 0; ///< at most; 0 = all
    /// Own: a waiting frame is discarded for a newer one. Fastest (files): every frame, with the time of reading
    /// as its capture time.
    ar::Pace pace = ar::Pace::own;
    std::vector<ar::TimedPose> poses;                                      ///< of the left camera, as RunOptions
    std::function<std::optional<gi::RigidPose>(ar::Frame const&)> tracked; ///< likewise; called by the thread
};

/// The composites of one moment.
struct PassThroughFrame {
    std::uint64_t sequence = 0;
    double captured_s = 0, done_s = 0; ///< steady clock
    ar::UsedPose used;                 ///< of the left camera; without a pose the frames are unchanged
    bool is_estimated = false;         ///< the frame has an estimate of its own, or a known pose
    double confidence = 0;             ///< of the frame's own estimate; 0 without one
    std::vector<cv::Mat> rgb;          ///< CV_8UC3, left and right, or one for both
};

struct PassThroughCounts {
    std::uint64_t frames = 0;
    ar::PoseTally poses;
    std::uint64_t overtaken = 0; ///< discarded for a newer one
    std::uint64_t refused = 0;   ///< unusable
    std::uint64_t alone = 0;     ///< left frames without a right frame at the same time
    ar::SourceCounts left, right;
    ar::SourceState end;
};

class PassThrough {
public:
    /// Opens cameras, loads scenes and starts. All arguments must outlive it.
    /// @throws gi::InputError, gi::InputError
    PassThrough(ar::Session const& session, PassThroughOptions const& options, gi::Report& report);
    ~PassThrough();

    std::vector<ar::CameraModel> const& cameras() const { return models_; } ///< left and right, or one
    std::shared_ptr<PassThroughFrame const> newest() const;
    bool has_ended() const { return ended_; }
    /// Stops after the current frame.
    void end();
    PassThroughCounts counts() const;
    void rethrow() const; ///< call after the end: rethrows its thread's exception

private:
    struct Side;
    void run();
    std::shared_ptr<PassThroughFrame> composited(ar::Frame const& left, ar::Frame const* right, double time_s);

    ar::Session const& session_;
    PassThroughOptions const& options_;
    gi::Report& report_;
    std::vector<ar::CameraModel> models_;
    std::vector<std::unique_ptr<Side>> sides_;
    gi::StopRequest stop_;
    std::atomic<bool> ended_{false};
    mutable std::mutex mutex_; ///< guards the members below
    std::shared_ptr<PassThroughFrame const> newest_;
    PassThroughCounts counts_;
    std::exception_ptr problem_;
    std::thread thread_; ///< last member, so that it starts after all others are initialised
};

} // namespace viewer
