#include "ar/pipeline/pipeline.h"

#include "ar/capture/clock.h"
#include "ar/pipeline/bridge.h"
#include "ar/scene/real_scene.h"
#include "gi/core/error.h"
#include "gi/scene/load/load.h"

#include <algorithm>
#include <fmt/format.h>

namespace ar {
namespace {

/// Milliseconds since the last call, without gaps between calls.
class Lap {
public:
    explicit Lap(double begun_s) : last_s_(begun_s) {}
    double operator()() { return until(steady_now_s()); }
    double until(double now_s) { return 1e3 * (now_s - std::exchange(last_s_, now_s)); }
    double last_s() const { return last_s_; }

private:
    double last_s_;
};

LocalScene local_scene(Session const& s, gi::Report& report)
{
    PlacedScene const& v = s.virtual_things;
    return join_scenes(real_scene(s.real, report),
                       v.scene.empty() ? gi::Scene{} : gi::load_scene(v.scene.string(), report), placement(v));
}

CompositeSettings with_noise(CompositeSettings settings, SensorNoise const& noise)
{
    settings.noise = noise;
    return settings;
}

} // namespace

void check_size(glm::ivec2 frames_px, CalibratedCamera const& camera)
{
    glm::ivec2 const calibrated_px = camera.model.size_px;
    if (frames_px == calibrated_px) return;
    throw gi::InputError(fmt::format("frames of {} x {} pixels", frames_px.x, frames_px.y),
                         fmt::format("the calibration is of {} x {}", calibrated_px.x, calibrated_px.y),
                         "set the camera to that size, or calibrate it at this one");
}

Pipeline::Pipeline(Session const& session, CalibratedCamera const& camera, MarkerMap const& markers,
                   gi::Report& report, std::string prefix, bool poses_only)
    : session_(session),
      camera_(camera),
      renderer_(local_scene(session, report), session.render.settings, report, session.render.method),
      light_(session, report),
      compositor_(camera.photometry,
                  with_noise(session.composite, session.match_noise ? camera.noise : SensorNoise{})),
      poses_(session.pose, markers, camera.model),
      report_(report),
      prefix_(std::move(prefix))
{
    if (session.occlusion && !poses_only) occluders_.emplace(*session.occlusion, camera.model, report);
    renderer_.set_environment(light_.begin());
    bool const may_be_lit = !session.light.empty() || session.light_from_frame || session.live_light > 0;
    if (gi::World const& w = renderer_.world(); !poses_only && !session.virtual_things.scene.empty() &&
                                                !may_be_lit && w.lights.empty() && w.emitters.empty() &&
                                                !w.environment)
        report.lose("in doubt: sessions without any light, whose virtual objects are black", 1,
                    "write light: to one");
    std::string const why = renderer_.choose(session.render.light);
    lit_by_ = renderer_.is_prefiltered() ? "prefiltered light" : fmt::format("paths ({})", why);
    session_.render.resolution = resolution_of(session.render, renderer_.is_prefiltered());
    if (!poses_only)
        finish_.emplace(session_, camera.model, markers,
                        renderer_.is_prefiltered() ? PixelPoints::one : PixelPoints::many);
    light_picture_ = picture_of_light(light_.map());
}

void Pipeline::render(FrameResult& found, Frame const& frame, double time_s, gi::StopRequest const& stop)
{
    CameraModel const& pinhole = finish_->pinhole();
    gi::RigidPose const& world_from_camera = *found.used.world_from_camera;
    PairPictures const p =
        renderer_.render(gi_camera(pinhole, world_from_camera), pinhole.size_px.x, pinhole.size_px.y,
                         session_.render.paths, time_s, session_.render.denoise, stop);
    std::vector<glm::dvec3> const corners_m = renderer_.virtual_corners(time_s);
    found.visibility =
        visibility_of(camera_.model, world_from_camera, corners_m, cv::countNonZero(p.coverage) > 0);
    for (glm::dvec3 const& corner : corners_m)
        found.virtual_m = std::min(found.virtual_m, glm::length(corner - world_from_camera.position));
    FinishFrame of{{}, world_from_camera, time_s, frame.exposure.time_s};
    if (finish_->needs_radiance()) of.radiance = radiance_of(found.camera, camera_.photometry, frame.exposure);
    found.pair = (*finish_)(p, of, finish_->needs_world() ? renderer_.world_with(time_s) : renderer_.world());
    if (found.used.shown < 1) found.pair = faded(*found.pair, found.used.shown);
    if (keeps_depth_ || occluders_) found.depth = finish_->depth_of(p);
    if (!occluders_) return;
    LiveOccluderCounts const before = occluders_->counts();
    occluders_->hide(*found.pair, found.depth->composite, frame.sequence, time_s);
    LiveOccluderCounts const& now = occluders_->counts();
    std::string const where = fmt::format("frame {}", frame.sequence);
    report_.lose("frames without their depth picture", now.without_depth - before.without_depth, where);
    report_.lose("frames without their matte", now.without_matte - before.without_matte, where);
    report_.lose("depth pictures and mattes that cannot be used", now.unusable - before.unusable,
                 now.last_problem);
    report_occluders();
}

void Pipeline::report_occluders()
{
    LiveOccluderCounts const& c = occluders_->counts();
    count_some("frames with a depth picture or a matte", c.frames);
    count_some("pixels of virtual objects hidden by them", c.pixels.hidden);
    count_some("pixels of virtual objects without a measured depth", c.pixels.holes);
}

void Pipeline::count_some(char const* what, std::size_t n)
{
    if (n > 0) report_.count(prefix_ + what, double(n));
}

void Pipeline::report_poses()
{
    TrackerCounts const& t = poses_.tracker();
    if (auto const* const f = poses_.features()) {
        count_some("frames recognised anew by features", f->relocated);
        count_some("frames whose features were not recognised", f->not_relocated);
    }
    count_some("poses taken", t.taken);
    count_some("poses missed", t.missed);
    count_some("poses refused as jumps", t.jumps_refused);
    count_some("jumps believed", t.jumps_believed);
    count_some("moves of the tripod", t.moves);
    for (std::size_t k = 0; k < kPoseStates; ++k)
        count_some(("frames " + name_of(PoseState(k))).c_str(), poses_.states()[k]);
}

void Pipeline::report_finish()
{
    FinishCounts const& f = finish_->counts();
    count_some("enlarged pixels whose surface no rendered one shows", f.upsample.without_guide);
    count_some("enlarged pixels among virtual objects alone", f.upsample.no_sample);
    count_some("points of virtual objects without light", f.unlit);
    count_some("pixels at borders of real occluders", f.matte.band);
    count_some("pixels at borders of real occluders, refined", f.matte.refined);
    count_some("frames whose sharpness was measured", f.blur.measured);
    count_some("frames without an edge to measure", f.blur.unmeasured);
    count_some("frames blurred by motion", f.blur.moved);
    count_some("frames of unknown exposure time", session_.finish.match_blur ? f.blur.no_exposure : 0);
    if (f.camera_sigma_px > 0) report_.count("blur of the camera (px)", f.camera_sigma_px);
    if (f.added_sigma_px > 0) report_.count("blur that was added (px)", f.added_sigma_px);
}

FrameResult Pipeline::find(Frame const& frame, double time_s,
                           std::optional<std::optional<gi::RigidPose>> const& known, std::optional<double> begun_s,
                           gi::StopRequest const* stop)
{
    if (frame.size_px != camera_.model.size_px)
        throw gi::InputError(
            fmt::format("frame {} has {} x {} pixels", frame.sequence, frame.size_px.x, frame.size_px.y),
            fmt::format("the calibration is of {} x {}", camera_.model.size_px.x, camera_.model.size_px.y),
            "set the camera to that size, or calibrate it at this one");
    FrameResult r;
    Lap lap(begun_s ? *begun_s : steady_now_s());
    r.camera = picture_of(frame);
    cv::Mat const gray = gray_of(frame);
    r.times.decode_ms = lap();
    FoundPose f = known ? poses_.next(time_s, *known) : poses_.next(time_s, gray, stop);
    losses_.add(f, frame.sequence, report_, prefix_);
    r.sighting = std::move(f.sighting);
    r.pose = std::move(f.pose);
    r.used = f.used;
    r.lost_by = std::move(f.lost_by);
    if (f.detected_s) r.times.detect_ms = lap.until(*f.detected_s);
    report_poses();
    r.times.pose_ms = lap();
    r.rgb = r.camera;
    r.done_s = lap.last_s();
    return r;
}

void Pipeline::add(FrameResult& r, Frame const& frame, double time_s, gi::StopRequest const& stop,
                   CompositeBy composite)
{
    Lap lap(r.done_s);
    r.times.wait_ms = lap();
    if (r.used.world_from_camera) {
        // Only a measured pose says from which direction the light of a pixel comes.
        if (r.used.state == PoseState::tracked)
            if (auto map = light_.follow(r.camera, camera_.photometry, frame.exposure, camera_.model,
                                         *r.used.world_from_camera, time_s, stop, report_)) {
                renderer_.set_environment(std::move(map));
                light_picture_ = picture_of_light(light_.map());
            }
        r.times.light_ms = lap();
        render(r, frame, time_s, stop);
        r.times.render_ms = lap();
        if (composite == CompositeBy::pipeline) {
            r.rgb = cv::Mat(); // the camera's stays as it is
            r.counts = compositor_(r.camera, *r.pair, frame.exposure, r.rgb, frame.sequence);
        }
        r.times.composite_ms = lap();
        report_finish();
    } else {
        finish_->forget();
    }
    r.light = light_picture_;
    r.done_s = lap.last_s();
}

} // namespace ar
