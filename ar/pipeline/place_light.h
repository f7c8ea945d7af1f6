#pragma once
// The light of the place: the captured environment map, or an estimate that is updated from the camera's frames.

#include "ar/camera/frame.h"
#include "ar/light/live_probe.h"
#include "ar/pipeline/posed_frame.h"
#include "ar/scene/session_file.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"

#include <memory>

namespace ar {

class PlaceLight {
public:
    /// @throws gi::InputError the map cannot be read
    PlaceLight(Session const& session, gi::Report& report);

    /// The captured map; with `from: frame`, grey until a frame was seen; null: none.
    std::shared_ptr<gi::EnvironmentMap const> begin() const;
    /// Updates the estimate with a frame. The first one takes a second or two with `from: frame`; a frame that
    /// does not suffice is counted in the report, and the next one is tried.
    /// @return a new map if one is due or a lamp was switched; else null
    std::shared_ptr<gi::EnvironmentMap const> follow(cv::Mat const& rgb, Photometry const& photometry,
                                                     Exposure const& exposure, CameraModel const& camera,
                                                     gi::RigidPose const& world_from_camera, double time_s,
                                                     gi::StopRequest const& stop, gi::Report& report);
    /// The current map: lat-long radiance, CV_32FC3; empty = none.
    cv::Mat map() const { return probe_ ? probe_->map() : captured_; }

private:
    bool estimate(PosedFrame const& frame, Photometry const& photometry, CameraModel const& camera,
                  gi::StopRequest const& stop, gi::Report& report);

    cv::Mat captured_;             ///< in the world's frame; empty = none
    std::optional<RealPlace> unseen_; ///< real surfaces from which the light is still to be estimated
    std::optional<LiveProbe> probe_;
    int every_, frames_ = 0;
};

/// Picture of the map for display: CV_8UC3 RGB, 128 x 64, exposed for its middle tones; empty for an empty map.
cv::Mat picture_of_light(cv::Mat const& map);

} // namespace ar
