#pragma once
// Writes the parts of composites (ar/composite/passes.h) with depth and motion as one multi-layer EXR per frame,
// for compositing programs. docs/ar.md describes the layers.

#include "ar/composite/passes.h"
#include "ar/composite/warp.h"
#include "ar/runtime/picture_thread.h"
#include "ar/runtime/runner.h"
#include "gi/image_io/picture_file.h"

#include <filesystem>
#include <memory>

namespace ar {

struct PlacedFrame {
    std::uint64_t sequence = 0;
    gi::RigidPose world_from_camera;
};

/// A frame and its result, as they wait to be written.
struct PassFrame {
    std::uint64_t sequence = 0;
    Exposure exposure;
    cv::Mat camera, composite; ///< as FrameResult
    std::optional<RenderedPair> pair;
    std::optional<SeenDepth> depth;
    PoseState state = PoseState::lost;
    double shown = 0;                               ///< as UsedPose
    std::optional<gi::RigidPose> world_from_camera; ///< the pose that was used
    std::optional<PlacedFrame> before;         ///< the last frame written, if it had a pose of its own
};

/// The passes of one frame as layers and metadata.
class PassLayers {
public:
    /// @param frames_per_s  of the source; 0 = unknown
    PassLayers(CameraModel const& camera, Compositor compositor, double frames_per_s, bool is_undistorted);

    gi::Picture picture(PassFrame const& frame);
    gi::ExrAttributes attributes(PassFrame const& frame) const;

private:
    cv::Mat motion(cv::Mat const& depth_m, gi::RigidPose const& now, gi::RigidPose const& before) const;

    CameraModel camera_, shown_; ///< of the frames, of the layers
    Compositor compositor_;
    std::optional<Warp> undistort_;
    double frames_per_s_ = 0;
    cv::Mat directions_; ///< CV_32FC2: of the camera's pixels on the plane z = 1
};

class PassFolder {
public:
    /// @throws gi::InputError if the folder cannot be created
    PassFolder(PassSettings const& settings, CameraModel const& camera, Compositor compositor, double frames_per_s,
               WhenFull when_full, gi::Report& report);

    /// Writes sequence.exr in a separate thread. @throws the error of an earlier frame
    void add(RunFrame const& record, FrameResult const& result);
    /// Waits until all are written. @throws as `add`
    void finish() { thread_->finish(); }
    std::uint64_t lost() const { return thread_->lost(); } ///< frames, as the disk was too slow

private:
    PassSettings settings_;
    PassLayers layers_;
    std::optional<PlacedFrame> before_;
    std::unique_ptr<KeepThread<PassFrame>> thread_;
};

} // namespace ar
