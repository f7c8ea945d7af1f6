#pragma once
// The light of the place: the map that was captured there, or an estimate that the camera's own frames keep up to
// date.

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

    /// As it was captured; null: there is no map.
    std::shared_ptr<gi::EnvironmentMap const> begin() const;
    /// What a frame tells of it. @return a new map where it is time for one, or a lamp was switched: else null
    std::shared_ptr<gi::EnvironmentMap const> follow(cv::Mat const& rgb, ar::Photometry const& photometry,
                                                     ar::Exposure const& exposure, ar::CameraModel const& camera,
                                                     glm::dquat const& world_from_camera, double time_s);
    /// As it is now: lat-long radiance, CV_32FC3; empty = none.
    cv::Mat map() const { return probe_ ? probe_->map() : captured_; }

private:
    cv::Mat captured_; ///< in the world's frame; empty = none
    std::optional<ar::LiveProbe> probe_;
    int every_, frames_ = 0;
};

/// For people to look at: CV_8UC3 RGB, 128 x 64, exposed for its middle tones. Empty of an empty map.
cv::Mat picture_of_light(cv::Mat const& map);

} // namespace viewer
