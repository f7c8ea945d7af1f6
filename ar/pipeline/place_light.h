#pragma once
// The light of the place: the captured environment map, or an estimate that is updated from the camera's frames.

#include "ar/camera/frame.h"
#include "ar/light/live_probe.h"
#include "ar/scene/session_file.h"
#include "gi/scene/model/scene.h"

#include <memory>

namespace viewer {

class PlaceLight {
public:
    /// @throws gi::InputError the map cannot be read
    explicit PlaceLight(ArSession const& session);

    /// The captured map; null: none.
    std::shared_ptr<gi::EnvironmentMap const> begin() const;
    /// Updates the estimate with a frame. @return a new map if one is due or a lamp was switched; else null
    std::shared_ptr<gi::EnvironmentMap const> follow(cv::Mat const& rgb, ar::Photometry const& photometry,
                                                     ar::Exposure const& exposure, ar::CameraModel const& camera,
                                                     glm::dquat const& world_from_camera, double time_s);
    /// The current map: lat-long radiance, CV_32FC3; empty = none.
    cv::Mat map() const { return probe_ ? probe_->map() : captured_; }

private:
    cv::Mat captured_; ///< in the world's frame; empty = none
    std::optional<ar::LiveProbe> probe_;
    int every_, frames_ = 0;
};

/// Picture of the map for display: CV_8UC3 RGB, 128 x 64, exposed for its middle tones; empty for an empty map.
cv::Mat picture_of_light(cv::Mat const& map);

} // namespace viewer
