#include "viewer/offline/frame_follower.h"

#include "gi/core/error.h"
#include "viewer/offline/start_frames.h"

namespace viewer {

FrameFollower::FrameFollower(std::shared_ptr<gi::Scene const> scene, double time_s, gi::Method const& method,
                             gi::RenderSettings const& settings, int most_frames, std::optional<gi::dvec3> origin)
    : method_(method),
      settings_(settings),
      world_(std::move(scene), time_s, report_, origin),
      flat_(world_.advance(time_s)),
      reuse_({.most_frames = most_frames})
{
}

gi::World const& FrameFollower::go_to(double time_s)
{
    gi::Changes const changes = world_.advance(time_s);
    flat_.see(changes, report_);
    changes_.add(changes);
    return world_.world();
}

FrameFollower::Frame FrameFollower::render(gi::Camera const& camera, gi::StopRequest const& stop,
                                           gi::RenderProgress const& progress, gi::Report& report)
{
    if (camera.orthographic)
        throw gi::InputError("--reuse with an orthographic camera", "it has no motion vectors",
                             "leave out --reuse, or choose a perspective camera");
    bool const first = renderer_ == nullptr;
    if (first) {
        renderer_ = start_frames(method_, world_, camera, settings_, report_, stop);
        if (method_.choose != nullptr)
            choice_ = method_.choose(world_.world(), settings_, camera, gi::RenderUse::frames);
    } else {
        renderer_->changed(changes_);
    }
    Frame frame;
    frame.result = renderer_->frame(camera, stop, progress);
    if (choice_) {
        frame.result.method = choice_->method;
        frame.result.why_method = choice_->why.text;
    }
    if (frame.result.end == gi::RenderEnd::interrupted) return frame;
    {
        gi::StageTimer const timer(report_, "temporal reuse");
        frame.counts =
            reuse_.add(frame.result.picture, scene_change(changes_, first || !(camera == last_camera_)));
    }
    frame.changes = changes_.reasons;
    changes_ = {};
    last_camera_ = camera;
    for (auto const& [stage, seconds] : added_.times()) report.add_time(stage, seconds);
    added_.pass_on_losses(report);
    return frame;
}

} // namespace viewer
