#include "viewer/ar/pipeline.h"

#include "ar/base/error.h"
#include "ar/capture/clock.h"
#include "gi/base/error.h"
#include "gi/scene/load.h"
#include "viewer/ar/bridge.h"
#include "viewer/ar/real_scene.h"

#include <fmt/format.h>

namespace viewer {
namespace {

/// Milliseconds since the last call; no time is between two of them.
class Lap {
public:
    explicit Lap(double begun_s) : last_s_(begun_s) {}
    double operator()()
    {
        double const now_s = ar::steady_now_s();
        return 1e3 * (now_s - std::exchange(last_s_, now_s));
    }
    double last_s() const { return last_s_; }

private:
    double last_s_;
};

LocalScene local_scene(ArSession const& s, gi::Report& report)
{
    ArPlaced const& v = s.virtual_things;
    return join_scenes(real_scene(s.real, report),
                       v.scene.empty() ? gi::Scene{} : gi::load_scene(v.scene.string(), report), placement(v));
}

gi::RenderSettings render_settings(ArRender const& r)
{
    gi::RenderSettings settings;
    settings.bounces = r.bounces;
    settings.seed = r.seed;
    settings.slhb = r.slhb;
    return settings;
}

ar::CompositeSettings with_noise(ar::CompositeSettings settings, ar::SensorNoise const& noise)
{
    settings.noise = noise;
    return settings;
}

} // namespace

ArPipeline::ArPipeline(ArSession const& session, ArCamera const& camera, ar::MarkerMap const& markers,
                       gi::Report& report)
    : session_(session),
      camera_(camera),
      detector_(markers),
      renderer_(local_scene(session, report), render_settings(session.render), report),
      light_(session),
      warp_(camera.model, ar::covering_pinhole(camera.model, session.render.resolution)),
      compositor_(camera.photometry, with_noise(session.composite, camera.noise))
{
    renderer_.set_environment(light_.begin());
    light_picture_ = picture_of_light(light_.map());
    if (session.smoothing < 1) {
        ar::TemporalSettings smooth;
        smooth.weight = float(session.smoothing);
        filter_.emplace(warp_.from(), smooth);
    }
}

ar::RenderedPair ArPipeline::rendered(ar::Pose const& world_from_camera, double time_s,
                                      gi::StopRequest const& stop)
{
    ar::CameraModel const& pinhole = warp_.from();
    PairPictures const p =
        renderer_.render(gi_camera(pinhole, world_from_camera), pinhole.size_px.x, pinhole.size_px.y,
                         session_.render.paths, time_s, session_.render.denoise, stop);
    ar::RenderedPair pair{p.with, p.without, p.coverage, p.direct};
    if (filter_) pair = (*filter_)(pair, p.depth_m, world_from_camera);
    return warp_(pair);
}

ArResult ArPipeline::find(ar::Frame const& frame, double time_s, std::optional<ar::Pose> const& known,
                          std::optional<double> begun_s)
{
    if (frame.size_px != camera_.model.size_px)
        throw ar::InputError(
            fmt::format("frame {} has {} x {} pixels", frame.sequence, frame.size_px.x, frame.size_px.y),
            fmt::format("the calibration is of {} x {}", camera_.model.size_px.x, camera_.model.size_px.y),
            "set the camera to that size, or calibrate it at this one");
    ArResult r;
    Lap lap(begun_s ? *begun_s : ar::steady_now_s());
    r.camera = ar::rgb_of(frame);
    cv::Mat const gray = ar::gray_of(frame);
    r.times.decode_ms = lap();
    if (known) {
        r.pose.failure = ar::PoseFailure::none;
        r.pose.world_from_camera = *known;
        r.pose.confidence = 1;
    } else {
        r.sighting = detector_.next(gray);
        r.times.detect_ms = lap();
        r.pose = ar::estimate_pose(r.sighting, camera_.model, tracker_.expected(time_s));
        tracker_.add(time_s, r.pose);
        r.times.pose_ms = lap();
    }
    r.rgb = r.camera;
    r.done_s = lap.last_s();
    return r;
}

void ArPipeline::add(ArResult& r, ar::Frame const& frame, double time_s, gi::StopRequest const& stop,
                     CompositeBy composite)
{
    Lap lap(r.done_s);
    r.times.wait_ms = lap();
    if (r.pose.found()) {
        if (auto map = light_.follow(r.camera, camera_.photometry, frame.exposure, camera_.model,
                                     r.pose.world_from_camera.rotation, time_s)) {
            renderer_.set_environment(std::move(map));
            light_picture_ = picture_of_light(light_.map());
        }
        r.times.light_ms = lap();
        r.pair = rendered(r.pose.world_from_camera, time_s, stop);
        r.times.render_ms = lap();
        if (composite == CompositeBy::pipeline) {
            r.rgb = cv::Mat(); // the camera's stays as it is
            r.counts = compositor_(r.camera, *r.pair, frame.exposure, r.rgb, frame.sequence);
        }
        r.times.composite_ms = lap();
    } else if (filter_) {
        filter_->forget();
    }
    r.light = light_picture_;
    r.done_s = lap.last_s();
}

} // namespace viewer
