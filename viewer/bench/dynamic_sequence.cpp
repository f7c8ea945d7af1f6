#include "viewer/bench/dynamic_sequence.h"

#include "gi/core/error.h"
#include "gi/methods/registry.h"
#include "viewer/offline/choose_camera.h"
#include "viewer/offline/frame_follower.h"
#include "viewer/offline/load_world.h"
#include "viewer/report/measure.h"

namespace viewer {
namespace {

constexpr Structure kStructures[] = {{"static", gi::Schedule::stored, false, false},
                                     {"rebuilt", gi::Schedule::stored, true, true},
                                     {"appended", gi::Schedule::stored, true, false},
                                     {"temporal", gi::Schedule::temporal, true, false},
                                     {"streamed", gi::Schedule::streamed, true, false}};

double time_of(DynamicOptions const& o, int frame) { return o.render.time_s.value_or(0) + frame / o.fps; }

} // namespace

Structure const& find_structure(std::string const& name)
{
    std::string known;
    for (Structure const& s : kStructures) {
        if (s.name == name) return s;
        known += (known.empty() ? "" : ", ") + std::string(s.name);
    }
    throw gi::InputError("there is no structure '" + name + "'", "slhb does not have it", "choose of: " + known);
}

DynamicSequence::DynamicSequence(DynamicOptions const& o, std::shared_ptr<gi::Scene const> const& scene,
                                 Structure const& structure, gi::RenderSettings const& settings,
                                 gi::Report& report)
    : o_(o),
      structure_(structure),
      settings_(settings),
      report_(report),
      world_(scene, time_of(o, 0), report),
      flat_(world_.advance(time_of(o, 0))),
      renderer_(start()),
      reuse_({.most_frames = o.most_frames}),
      stages_(report)
{
    stages_.times();
}

gi::Camera DynamicSequence::eye() const { return choose_camera(world(), camera_choice(o_.render)).camera; }

std::unique_ptr<gi::FrameRenderer> DynamicSequence::start()
{
    return gi::find_method("slhb").frames(world_, eye(), settings_, report_);
}

DynamicSequence::Frame DynamicSequence::next(gi::DenoiseSettings const& filter, bool wants_alone)
{
    Frame f;
    FrameSeconds& s = f.seconds;
    gi::Changes changes;
    double build_s = 0;
    if (structure_.moves && frame_ > 0) {
        s.world = seconds_of([&] { changes = world_.advance(time_of(o_, frame_)); });
        flat_.see(changes, report_);
        build_s = seconds_of([&] {
            if (structure_.anew) {
                renderer_.reset(); // frees its memory for the next one
                renderer_ = start();
            } else {
                renderer_->changed(changes);
            }
        });
    }
    gi::Camera const now = eye();
    gi::RenderResult result;
    double const render_s = seconds_of([&] { result = renderer_->frame(now, {}, {}); });
    if (wants_alone && o_.most_frames > 1) {
        f.alone = result.picture;
        gi::denoise(f.alone, filter);
    }
    if (o_.most_frames > 1)
        s.reuse = seconds_of(
            [&] { reuse_.add(result.picture, scene_change(changes, frame_ == 0 || !(now == last_eye_))); });
    s.filter = seconds_of([&] { gi::denoise(result.picture, filter); });

    std::map<std::string, double> spent = stages_.times();
    double const direct = spent["direct light, thread seconds"],
                 indirect = spent["indirect light, thread seconds"], light = direct + indirect;
    s.structures = build_s + spent["hit buffers of a pass"] + spent["layers that moved"];
    s.shadow_maps = spent["shadow maps"];
    s.g_buffer = spent["G-buffer"];
    s.direct = light > 0 ? spent["paths"] * direct / light : 0;
    s.indirect = light > 0 ? spent["paths"] * indirect / light : 0;
    s.whole = s.world + build_s + render_s + s.reuse + s.filter;
    f.paths = result.paths;
    f.picture = std::move(result.picture);
    last_eye_ = now;
    ++frame_;
    return f;
}

} // namespace viewer
