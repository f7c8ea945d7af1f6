#pragma once
// From a camera's frame to the same frame with virtual things in it: detect, find the camera, render with and
// without, composite.

#include "ar/base/frame.h"
#include "ar/composite/composite.h"
#include "ar/markers/detect.h"
#include "ar/pose/tracker.h"
#include "viewer/ar/pair_finish.h"
#include "viewer/ar/pair_renderer.h"
#include "viewer/ar/place_light.h"

namespace viewer {

struct ArTimes {
    double decode_ms = 0, detect_ms = 0, pose_ms = 0, light_ms = 0, render_ms = 0, composite_ms = 0;
};

/// What the camera is, as a calibration file says.
struct ArCamera {
    ar::CameraModel model;
    ar::Photometry photometry;
    ar::SensorNoise noise;
};

struct ArResult {
    cv::Mat rgb;    ///< CV_8UC3; without a pose: the camera's frame as it came
    cv::Mat camera; ///< the camera's frame
    ar::Sighting sighting;
    ar::PoseEstimate pose;
    ar::CompositeCounts counts;
    std::optional<ar::RenderedPair> pair; ///< in the camera's lens
    ArTimes times;
};

class ArPipeline {
public:
    /// Loads the scenes and the light. @throws gi::InputError, ar::InputError
    ArPipeline(ArSession const& session, ArCamera const& camera, ar::MarkerMap const& markers, gi::Report& report);

    /// @param time_s  since the first frame: of the virtual things' clips, the camera's motion and the light
    /// @param known   where the camera is, in place of what the frame says
    /// @throws ar::InputError the frame cannot be decoded or has another size than the calibration
    ArResult process(ar::Frame const& frame, double time_s, std::optional<ar::Pose> const& known,
                     gi::StopRequest const& stop);

    /// Without anything being rendered.
    ArResult find_pose(ar::Frame const& frame, double time_s);

private:
    ArResult seen(ar::Frame const& frame, double time_s, std::optional<ar::Pose> const& known);
    ar::RenderedPair rendered(ArResult const& found, ar::Exposure const& exposure, double time_s,
                              gi::StopRequest const& stop);
    void report_counts();

    ArSession session_;
    ArCamera camera_;
    ar::MarkerTracker detector_;
    PairRenderer renderer_;
    PlaceLight light_;
    PairFinish finish_;
    ar::Compositor compositor_;
    ar::PoseTracker tracker_;
    std::uint64_t predicted_ = 0; ///< frames
    gi::Report& report_;
};

} // namespace viewer
