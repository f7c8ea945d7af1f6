#include "viewer/engine/method_runner.h"

#include "gi/filter/filter_names.h"

#include <limits>

namespace viewer {
namespace {

/// A still picture is filtered only while it has few paths, so that it converges to the method's own result.
constexpr int kFilteredFrames = 48;
/// Likewise, light is reused from the other eye only at first.
constexpr int kSharedFrames = 16;

/// Orthographic cameras have no motion vectors: no temporal reuse while anything moves.
void without_motion(gi::Picture& picture)
{
    if (picture.find("motion") != nullptr) return;
    gi::Layer& motion = picture.add("motion", 3);
    std::fill(motion.data.begin(), motion.data.end(), std::numeric_limits<float>::quiet_NaN());
}

} // namespace

gi::SceneChange scene_change(gi::Changes const& c, bool camera_moved)
{
    if (c.lights || c.materials || c.coverage || c.emitters || c.environment) return gi::SceneChange::light;
    return c.geometry || camera_moved ? gi::SceneChange::motion : gi::SceneChange::nothing;
}

MethodRunner::MethodRunner(std::string const& method, gi::MovingWorld const& world, Settings const& settings,
                           int threads, SceneStart const& start, gi::Report& report, bool ahead)
    : report_(report), threads_(threads), ahead_(ahead)
{
    gi::RenderSettings s = settings.render;
    s.threads = threads;
    s.paths = 1;
    s.slhb.cache = gi::RadianceCaching::automatic;       // render() says for every frame whether paths end in it
    s.width = std::max(1, int(std::sqrt(start.pixels))); // the plan needs only the number of pixels
    s.height = std::max(1, int(std::lround(start.pixels / s.width)));
    // Use the same axes for all frames: fresh axes in every frame would flicker.
    if (s.slhb.schedule == gi::Schedule::automatic && method == "slhb") s.slhb.schedule = gi::Schedule::stored;
    s.slhb.interleave = 1;
    renderer_ = gi::find_method(method).frames(world, start.camera, s, report);
}

std::vector<gi::RenderResult> MethodRunner::render(FrameCommand const& command,
                                                   std::span<HiddenPixels const> hidden,
                                                   gi::Changes const& changes, Settings const& settings,
                                                   gi::StopRequest const& stop)
{
    if (!first_ || ahead_) renderer_->changed(changes);
    bool anything_moved = first_ || seen_.size() != command.views.size() || changes.any();
    seen_.resize(command.views.size());
    std::vector<bool> moved(command.views.size());
    for (std::size_t k = 0; k < command.views.size(); ++k) {
        ViewCommand const& now = command.views[k];
        Seen& s = seen_[k];
        bool const same = s.reuse && s.name == now.name && s.width == now.width && s.height == now.height &&
                          s.most_frames == settings.reuse;
        if (!same) s.reuse = std::make_unique<gi::TemporalReuse>(gi::TemporalSettings{settings.reuse});
        moved[k] = !same || !(s.camera == now.camera) || s.hidden != hidden[k];
        anything_moved |= moved[k];
        s = {now.name, now.camera, now.width, now.height, std::move(s.reuse), settings.reuse, hidden[k]};
    }
    first_ = false;
    still_ = anything_moved ? 1 : still_ + 1;
    std::vector<gi::FrameView> views;
    for (std::size_t k = 0; k < command.views.size(); ++k) {
        ViewCommand const& v = command.views[k];
        views.push_back(
            {v.camera, v.width, v.height, settings.share_eyes && still_ <= kSharedFrames ? v.partner : -1});
        if (hidden[k]) views.back().hidden = *hidden[k];
    }
    // Its blur would stay in the mean of a still picture.
    gi::RadianceCaching const cache = settings.render.slhb.cache;
    bool const cached =
        cache == gi::RadianceCaching::on || (cache == gi::RadianceCaching::automatic && anything_moved);
    auto const sharing = cached ? gi::VertexSharing::cached : gi::VertexSharing::exact;
    renderer_->update_axes(settings.has_automatic_schedule() ? settings.updated_axes : 0);
    std::vector<gi::RenderResult> results = renderer_->views(views, std::uint32_t(command.paths), sharing, stop);
    for (std::size_t k = 0; k < results.size(); ++k)
        finish(k, results, views[k].partner, scene_change(changes, moved[k]), settings);
    return results;
}

void MethodRunner::finish(std::size_t view, std::vector<gi::RenderResult>& results, int partner,
                          gi::SceneChange change, Settings const& settings)
{
    gi::RenderResult& result = results[view];
    gi::ReusedLight taken;
    gi::TemporalReuse const* past = nullptr;
    if (!result.light_from.empty()) {
        taken = {&results[std::size_t(partner)].picture, result.light_from};
        past = seen_[std::size_t(partner)].reuse.get();
    }
    if (settings.reuse > 1) {
        gi::StageTimer const timer(report_, "temporal reuse");
        without_motion(result.picture);
        seen_[view].reuse->add(result.picture, change, past, taken.from);
    }
    gi::DenoiseSettings const filter = denoise_settings(settings, threads_);
    if (!gi::can_filter(filter, result.paths, settings.reuse > 1) || still_ > kFilteredFrames) return;
    gi::StageTimer const timer(report_, "denoise");
    gi::DenoiseReport const done = gi::denoise(result.picture, filter, taken);
    if (done.not_finite > 0) report_.lose("pixels not filtered, as a value is not finite", done.not_finite);
}

} // namespace viewer
