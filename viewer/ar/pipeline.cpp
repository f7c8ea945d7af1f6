#include "viewer/ar/pipeline.h"

#include "ar/base/error.h"
#include "gi/base/error.h"
#include "gi/scene/load.h"
#include "viewer/ar/bridge.h"
#include "viewer/ar/pose_use.h"
#include "viewer/ar/real_scene.h"

#include <chrono>
#include <fmt/format.h>

namespace viewer {
namespace {

using Clock = std::chrono::steady_clock;

/// Milliseconds since the last call.
class Lap {
public:
    double operator()()
    {
        auto const now = Clock::now();
        return std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count();
    }

private:
    Clock::time_point last_ = Clock::now();
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
      finish_(session, camera.model, markers),
      compositor_(camera.photometry,
                  with_noise(session.composite, session.match_noise ? camera.noise : ar::SensorNoise{})),
      tracker_(session.pose.tracker),
      report_(report)
{
    renderer_.set_environment(light_.begin());
}

ar::RenderedPair ArPipeline::rendered(ArResult const& found, ar::Exposure const& exposure, double time_s,
                                      gi::StopRequest const& stop)
{
    ar::CameraModel const& pinhole = finish_.pinhole();
    ar::Pose const& world_from_camera = found.pose.world_from_camera;
    PairPictures const p =
        renderer_.render(gi_camera(pinhole, world_from_camera), pinhole.size_px.x, pinhole.size_px.y,
                         session_.render.paths, time_s, session_.render.denoise, stop);
    FinishFrame frame{{}, world_from_camera, time_s, exposure.time_s};
    if (finish_.needs_radiance()) frame.radiance = ar::radiance_of(found.camera, camera_.photometry, exposure);
    return finish_(p, frame, finish_.needs_world() ? renderer_.world_with(time_s) : renderer_.world());
}

void ArPipeline::report_counts()
{
    ar::TrackerCounts const& t = tracker_.counts();
    auto const count = [&](char const* what, std::size_t n) {
        if (n > 0) report_.count(what, double(n));
    };
    count("poses taken", t.taken);
    count("poses missed", t.missed);
    count("poses refused as jumps", t.jumps_refused);
    count("jumps believed", t.jumps_believed);
    count("moves of the tripod", t.moves);
    count("poses predicted", predicted_);
    FinishCounts const& f = finish_.counts();
    count("enlarged pixels whose surface no rendered one shows", f.upsample.without_guide);
    count("enlarged pixels among virtual things alone", f.upsample.no_sample);
    count("points of virtual things without light", f.unlit);
    count("pixels at borders of real occluders", f.matte.band);
    count("pixels at borders of real occluders, refined", f.matte.refined);
    count("frames whose sharpness was measured", f.blur.measured);
    count("frames without an edge to measure", f.blur.unmeasured);
    count("frames blurred by motion", f.blur.moved);
    count("frames of unknown exposure time", session_.finish.match_blur ? f.blur.no_exposure : 0);
    if (f.camera_sigma_px > 0) report_.count("blur of the camera (px)", f.camera_sigma_px);
    if (f.added_sigma_px > 0) report_.count("blur that was added (px)", f.added_sigma_px);
}

ArResult ArPipeline::seen(ar::Frame const& frame, double time_s, std::optional<ar::Pose> const& known)
{
    if (frame.size_px != camera_.model.size_px)
        throw ar::InputError(
            fmt::format("frame {} has {} x {} pixels", frame.sequence, frame.size_px.x, frame.size_px.y),
            fmt::format("the calibration is of {} x {}", camera_.model.size_px.x, camera_.model.size_px.y),
            "set the camera to that size, or calibrate it at this one");
    ArResult r;
    Lap lap;
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
        if (use_pose(session_.pose, tracker_, time_s, r.pose)) ++predicted_;
        r.times.pose_ms = lap();
    }
    r.rgb = r.camera;
    return r;
}

ArResult ArPipeline::find_pose(ar::Frame const& frame, double time_s) { return seen(frame, time_s, std::nullopt); }

ArResult ArPipeline::process(ar::Frame const& frame, double time_s, std::optional<ar::Pose> const& known,
                             gi::StopRequest const& stop)
{
    ArResult r = seen(frame, time_s, known);
    if (!r.pose.found()) {
        finish_.forget();
        report_counts();
        return r;
    }
    Lap lap;
    if (auto map = light_.follow(r.camera, camera_.photometry, frame.exposure, camera_.model,
                                 r.pose.world_from_camera.rotation, time_s))
        renderer_.set_environment(std::move(map));
    r.times.light_ms = lap();
    r.rgb = cv::Mat(); // the camera's stays as it is
    r.pair = rendered(r, frame.exposure, time_s, stop);
    r.times.render_ms = lap();
    r.counts = compositor_(r.camera, *r.pair, frame.exposure, r.rgb, frame.sequence);
    r.times.composite_ms = lap();
    report_counts();
    return r;
}

} // namespace viewer
