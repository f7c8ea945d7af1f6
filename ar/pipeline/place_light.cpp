#include "ar/pipeline/place_light.h"

#include "ar/light/lat_long.h"
#include "ar/light/map_file.h"
#include "ar/pipeline/bridge.h"
#include "ar/pipeline/frame_light.h"
#include "gi/core/error.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace ar {

PlaceLight::PlaceLight(Session const& session, gi::Report& report) : every_(session.live_light)
{
    if (!session.light.empty()) {
        captured_ = read_map(session.light, &report) * session.light_scale;
        if (session.light_turn_deg != 0)
            captured_ = resampled(captured_, captured_.size(),
                                  glm::angleAxis(glm::radians(session.light_turn_deg), glm::dvec3(0, 1, 0)));
    }
    if (session.light_from_frame) {
        unseen_ = session.real;
        captured_ = cv::Mat(16, 32, CV_32FC3, cv::Scalar::all(0.3));
    } else if (every_ > 0) {
        probe_.emplace(captured_);
    }
}

std::shared_ptr<gi::EnvironmentMap const> PlaceLight::begin() const
{
    if (captured_.empty()) return nullptr;
    return std::make_shared<gi::EnvironmentMap const>(environment_of(captured_));
}

bool PlaceLight::estimate(PosedFrame const& frame, Photometry const& photometry, CameraModel const& camera,
                          gi::StopRequest const& stop, gi::Report& report)
{
    RealScene known;
    known.scene = real_scene(*unseen_, report);
    try {
        FrameLight const light =
            estimate_light(std::move(known), camera, photometry, std::span(&frame, 1), {}, stop, report);
        if (stop.requested()) return false;
        captured_ = light.map;
        report.count("unexplained shading of the frame that light was estimated from (%)",
                     100 * light.fit.residual);
        report.count("directions that it does not determine (%)", 100 * light.undetermined_share);
        report.count("lamps found in it", double(light.fit.lamps.size()));
    } catch (gi::InputError const& e) {
        report.lose("frames from which the light could not be estimated", 1, e.what());
        return false;
    }
    unseen_.reset();
    if (every_ > 0) probe_.emplace(captured_);
    return true;
}

std::shared_ptr<gi::EnvironmentMap const> PlaceLight::follow(cv::Mat const& rgb, Photometry const& photometry,
                                                             Exposure const& exposure, CameraModel const& camera,
                                                             gi::RigidPose const& world_from_camera, double time_s,
                                                             gi::StopRequest const& stop, gi::Report& report)
{
    if (unseen_)
        return estimate({rgb, exposure, world_from_camera}, photometry, camera, stop, report) ? begin() : nullptr;
    if (!probe_) return nullptr;
    ProbeUpdate const update = probe_->update(radiance_of(rgb, photometry, exposure), is_clipped(rgb), camera,
                                              world_from_camera.rotation, time_s);
    if (frames_++ % every_ != 0 && !update.lamp_changed) return nullptr;
    return std::make_shared<gi::EnvironmentMap const>(environment_of(probe_->map()));
}

cv::Mat picture_of_light(cv::Mat const& map)
{
    if (map.empty()) return {};
    cv::Mat small, log_luminance;
    cv::resize(map, small, {128, 64}, 0, 0, cv::INTER_AREA);
    cv::transform(small, log_luminance, cv::Matx13f(0.2126f, 0.7152f, 0.0722f));
    cv::log(cv::max(log_luminance, 1e-6), log_luminance);
    double const middle = std::exp(cv::mean(log_luminance)[0]);
    return bytes_of(small * (0.18 / middle), srgb_photometry());
}

} // namespace ar
