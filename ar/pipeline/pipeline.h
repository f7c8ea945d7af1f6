#pragma once
// Adds virtual objects to a camera's frame: detect markers, estimate the camera pose, render with and without
// virtual objects, composite.

#include "ar/camera/frame.h"
#include "ar/composite/composite.h"
#include "ar/pipeline/live_occluders.h"
#include "ar/pipeline/pair_finish.h"
#include "ar/pipeline/pair_renderer.h"
#include "ar/pipeline/place_light.h"
#include "ar/pipeline/pose_finder.h"
#include "ar/pipeline/pose_losses.h"
#include "ar/pipeline/visibility.h"

#include <limits>

namespace ar {

/// Consecutive stages without gaps: their sum is the time from delivery to `FrameResult::done_s`.
struct StageTimes {
    double decode_ms = 0, detect_ms = 0, pose_ms = 0;
    double wait_ms = 0; ///< waiting to be rendered
    double light_ms = 0, render_ms = 0, composite_ms = 0;
};

/// The camera's properties from its calibration file.
struct CalibratedCamera {
    CameraModel model;
    Photometry photometry;
    SensorNoise noise;
};

/// @throws gi::InputError if the frames' size differs from the calibration's
void check_size(glm::ivec2 frames_px, CalibratedCamera const& camera);

struct FrameResult {
    cv::Mat rgb;    ///< of the type of `camera`; without a pose: the camera's frame unchanged
    cv::Mat camera; ///< the camera's frame, with all its bits (picture_of)
    Sighting sighting;
    PoseEstimate pose; ///< the frame's own estimate, or the known pose
    UsedPose used;     ///< what the frame is composited with
    std::string lost_by; ///< FoundPose::lost_by
    CompositeCounts counts;
    Visibility visibility = Visibility::unknown; ///< of the virtual objects' surfaces
    /// From the camera to the nearest corner of the boxes around them.
    double virtual_m = std::numeric_limits<double>::infinity();
    std::optional<RenderedPair> pair;     ///< in the camera's lens
    std::optional<SeenDepth> depth;       ///< of the pair; only after Pipeline::keep_depth
    cv::Mat light;                        ///< CV_8UC3 RGB, thumbnail of the environment map used; empty = no map
    StageTimes times;
    double done_s = 0; ///< steady clock, end of the last stage
};

/// Where compositing is done.
enum class CompositeBy {
    pipeline,
    window ///< viewer/devices/gl/ar_composite_pass.h; `rgb` stays the camera's and there are no counts
};

/// Processes frames in two steps, `find` and `add`, which may run in two threads at once, as they share no mutable
/// state. Each must get the frames in order.
class Pipeline {
public:
    /// Loads the scenes and the light. @throws gi::InputError
    /// @param prefix  for its counts in the report, if there are several pipelines
    /// @param poses_only  `add` is never called: the lens may see more than a pinhole picture shows
    Pipeline(Session const& session, CalibratedCamera const& camera, MarkerMap const& markers, gi::Report& report,
             std::string prefix = {}, bool poses_only = false);

    /// Finds the camera's pose.
    /// @param time_s   since the first frame: time for animation clips, the camera's motion and the light
    /// @param known    the camera's pose by a tracker or a file, which may have none for this frame; not set: it is
    ///                 estimated
    /// @param begun_s  steady clock, start of the time measurement; nothing = now
    /// @param stop     null = none; a pose may be missing after a request
    /// @throws gi::InputError the frame cannot be decoded or has another size than the calibration
    FrameResult find(Frame const& frame, double time_s,
                     std::optional<std::optional<gi::RigidPose>> const& known = {},
                     std::optional<double> begun_s = {}, gi::StopRequest const* stop = nullptr);
    /// Adds the virtual objects, as far as `r.used` shows them.
    /// @param r  result of `find` for the same frame
    void add(FrameResult& r, Frame const& frame, double time_s, gi::StopRequest const& stop,
             CompositeBy composite = CompositeBy::pipeline);
    /// Results get their depth; call before the first frame.
    void keep_depth() { keeps_depth_ = true; }
    CalibratedCamera const& camera() const { return camera_; }
    Compositor const& compositor() const { return compositor_; }
    /// By prefiltered light, without paths.
    bool is_prefiltered() const { return renderer_.is_prefiltered(); }
    /// "prefiltered light", or "paths (why)".
    std::string const& lit_by() const { return lit_by_; }

private:
    /// Sets the pair, and its depth if needed.
    void render(FrameResult& found, Frame const& frame, double time_s, gi::StopRequest const& stop);
    void report_poses();
    void report_finish();
    void report_occluders();
    void count_some(char const* what, std::size_t n);

    Session session_;
    CalibratedCamera camera_;
    PairRenderer renderer_;
    PlaceLight light_;
    std::optional<PairFinish> finish_;
    std::optional<LiveOccluders> occluders_;
    Compositor compositor_;
    PoseFinder poses_;
    PoseLosses losses_;
    bool keeps_depth_ = false;
    cv::Mat light_picture_;
    std::string lit_by_;
    gi::Report& report_;
    std::string prefix_;
};

} // namespace ar
