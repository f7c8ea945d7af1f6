#pragma once
// From a camera's frame to the same frame with virtual things in it: detect, find the camera, render with and
// without, composite.

#include "ar/camera/frame.h"
#include "ar/composite/composite.h"
#include "ar/markers/detect.h"
#include "ar/pipeline/pair_finish.h"
#include "ar/pipeline/pair_renderer.h"
#include "ar/pipeline/place_light.h"
#include "ar/pose/tracker.h"

namespace viewer {

/// One after the other, without gaps: their sum is the time from being handed over to `ArResult::done_s`.
struct ArTimes {
    double decode_ms = 0, detect_ms = 0, pose_ms = 0;
    double wait_ms = 0; ///< for its turn to be rendered
    double light_ms = 0, render_ms = 0, composite_ms = 0;
};

/// What the camera is, as a calibration file says.
struct ArCamera {
    ar::CameraModel model;
    ar::Photometry photometry;
    ar::SensorNoise noise;
};

/// @throws gi::InputError frames of another size than the calibration's
void check_size(glm::ivec2 frames_px, ArCamera const& camera);

struct ArResult {
    cv::Mat rgb;    ///< CV_8UC3; without a pose: the camera's frame as it came
    cv::Mat camera; ///< the camera's frame
    ar::Sighting sighting;
    ar::PoseEstimate pose;
    ar::CompositeCounts counts;
    std::optional<ar::RenderedPair> pair; ///< in the camera's lens
    cv::Mat light;                        ///< CV_8UC3 RGB, the map that it was lit by, small; empty = no map
    ArTimes times;
    double done_s = 0; ///< steady clock, when the last of these had ended
};

/// Who puts what was rendered into the frame.
enum class CompositeBy {
    pipeline,
    window ///< viewer/devices/gl/ar_composite_pass.h; `rgb` stays the camera's and there are no counts
};

/// In two steps, `find` and `add`, which may be made by two threads at once: they share nothing that changes. Each
/// takes the frames in order.
class ArPipeline {
public:
    /// Loads the scenes and the light. @throws gi::InputError
    /// @param prefix  of its counts in the report, where there are several
    ArPipeline(ArSession const& session, ArCamera const& camera, ar::MarkerMap const& markers, gi::Report& report,
               std::string prefix = {});

    /// Where the camera is.
    /// @param time_s   since the first frame: of the virtual things' clips, the camera's motion and the light
    /// @param known    where the camera is, in place of what the frame says
    /// @param begun_s  steady clock, from when on its time counts; nothing = now
    /// @throws gi::InputError the frame cannot be decoded or has another size than the calibration
    ArResult find(ar::Frame const& frame, double time_s, std::optional<ar::Pose> const& known = {},
                  std::optional<double> begun_s = {});
    /// The virtual things, where a camera was found.
    /// @param r  of `find` for the same frame
    void add(ArResult& r, ar::Frame const& frame, double time_s, gi::StopRequest const& stop,
             CompositeBy composite = CompositeBy::pipeline);
    ar::Compositor const& compositor() const { return compositor_; }

private:
    ar::RenderedPair rendered(ArResult const& found, ar::Exposure const& exposure, double time_s,
                              gi::StopRequest const& stop);
    void report_poses();
    void report_finish();
    void count_some(char const* what, std::size_t n);

    ArSession session_;
    ArCamera camera_;
    ar::MarkerTracker detector_;
    PairRenderer renderer_;
    PlaceLight light_;
    PairFinish finish_;
    ar::Compositor compositor_;
    ar::PoseTracker tracker_;
    std::uint64_t predicted_ = 0; ///< frames
    cv::Mat light_picture_;
    gi::Report& report_;
    std::string prefix_;
};

} // namespace viewer
