#pragma once
// Composites for a headset, made in a thread of its own: of one camera for both eyes, or of one for each. With
// two, the left one is found by its frame and the right one stands where it is mounted; both are composited for
// the same moment of the same world.

#include "ar/capture/frame_source.h"
#include "ar/runtime/runner.h"
#include "gi/core/progress.h"

#include <atomic>
#include <mutex>
#include <thread>

namespace viewer {

struct PassThroughOptions {
    int frames = 0; ///< at most; 0 = all
    /// Own: a frame that waits is given up for a newer one. Fastest (files): every frame, as if it were taken when
    /// it is read.
    ar::Pace pace = ar::Pace::own;
    std::vector<ar::TimedPose> poses;                                 ///< of the left camera, as ArRunOptions
    std::function<std::optional<ar::Pose>(ar::Frame const&)> tracked; ///< likewise; by the thread
};

/// Of one moment.
struct PassThroughFrame {
    std::uint64_t sequence = 0;
    double captured_s = 0, done_s = 0; ///< steady clock
    bool is_found = false;             ///< the camera; else the frames are as they came
    std::vector<cv::Mat> rgb;          ///< CV_8UC3, left and right, or one for both
};

struct PassThroughCounts {
    std::uint64_t frames = 0, found = 0;
    std::uint64_t overtaken = 0; ///< given up, since a newer one was there
    std::uint64_t refused = 0;   ///< could not be used
    std::uint64_t alone = 0;     ///< of the left camera, without one of the right at the same time
    ar::SourceCounts left, right;
    ar::SourceState end;
};

class PassThrough {
public:
    /// Opens cameras, loads scenes, begins. All arguments outlive it. @throws gi::InputError
    PassThrough(ArSession const& session, PassThroughOptions const& options, gi::Report& report);
    ~PassThrough();

    std::vector<ar::CameraModel> const& cameras() const { return models_; } ///< left and right, or one
    std::shared_ptr<PassThroughFrame const> newest() const;
    bool has_ended() const { return ended_; }
    /// Until the frame at hand is done.
    void end();
    PassThroughCounts counts() const;
    void rethrow() const; ///< after the end: what its thread threw

private:
    struct Side;
    void run();
    std::shared_ptr<PassThroughFrame> composited(ar::Frame const& left, ar::Frame const* right, double time_s);

    ArSession const& session_;
    PassThroughOptions const& options_;
    gi::Report& report_;
    std::vector<ar::CameraModel> models_;
    std::vector<std::unique_ptr<Side>> sides_;
    gi::StopRequest stop_;
    std::atomic<bool> ended_{false};
    mutable std::mutex mutex_; ///< of what follows
    std::shared_ptr<PassThroughFrame const> newest_;
    PassThroughCounts counts_;
    std::exception_ptr problem_;
    std::thread thread_; ///< last: begins when all is there
};

} // namespace viewer
