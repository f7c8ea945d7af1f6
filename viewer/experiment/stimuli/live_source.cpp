#include "viewer/experiment/stimuli/live_source.h"

#include "gi/core/error.h"
#include "viewer/app/pose_at.h"

#include <algorithm>

namespace viewer {

LiveSource::LiveSource(SceneAccess const& scenes, int threads, SessionClock const& clock,
                       std::function<void()> published, gi::Report& report)
    : scenes_(scenes), clock_(clock), session_(scenes.load, threads, report)
{
    LiveRenderer::Hooks hooks;
    hooks.finished = [this](LiveFrame const& frame) {
        std::lock_guard const lock(mutex_);
        if (place_ && frame.begun_s >= settled_s_) ++warm_frames_;
    };
    hooks.published = std::move(published);
    hooks.failed = [this](std::string const& why) {
        std::lock_guard const lock(mutex_);
        error_ = why;
    };
    renderer_ = std::make_unique<LiveRenderer>(session_, clock_, nullptr, std::move(hooks));
}

LiveSource::~LiveSource() { renderer_->stop(); }

void LiveSource::post(Change const& change)
{
    renderer_->post(change, [this](std::string const& error) {
        if (error.empty()) return;
        std::lock_guard const lock(mutex_);
        if (error_.empty()) error_ = error;
    });
}

void LiveSource::post_settings(Settings const& wanted)
{
    for (Change const& c : differences(posted_, wanted)) post(c);
    posted_ = wanted;
}

void LiveSource::prepare(StimulusSettings const& stimulus, StimulusView const& view)
{
    rest();
    {
        std::lock_guard const lock(mutex_);
        error_.clear();
        place_.reset();
        warm_frames_ = 0;
    }
    Settings wanted = stimulus.settings;
    wanted.play = false; // until it is shown
    post_settings(wanted);
    navigation_.reset();
    drawn_scale_ = 0; // the screen has not seen it yet
    // Edits can only be undone by reloading the scene.
    if (stimulus.scene != scene_ || edited_) post({"scene", stimulus.scene});
    scene_ = stimulus.scene;
    edited_ = !stimulus.edits.empty();
    for (Change const& c : stimulus.edits) post(c);
    stimulus_ = stimulus;
    view_ = view;
    renderer_->go_to(0);
    renderer_->ask([this, name = stimulus.camera, plays = stimulus.settings.play](RenderSession& session) {
        std::lock_guard const lock(mutex_);
        if (!error_.empty()) return;
        try {
            place_ = place_of(session.world(), scenes_.camera(session.world(), name));
        } catch (gi::InputError const& e) {
            error_ = e.what();
            return;
        }
        settled_s_ = clock_.now_s();
        plays_ = plays && session.moves();
    });
}

/// Sets the camera for a time after the onset.
void LiveSource::look(double seconds)
{
    Viewpoint at;
    at.pose_s = at.display_s = clock_.now_s();
    {
        std::lock_guard const lock(mutex_);
        if (!place_) return;
        StimulusPlace place = *place_;
        if (navigation_) place.camera.world_from_camera = navigation_->world_from_camera();
        at.views = stimulus_views(place, stimulus_, view_, seconds);
        if (at.views.empty()) return; // unknown place, or the headset is not worn yet
        at.world_from_room = at.views[0].camera.world_from_camera;
    }
    at.drawn_scale = drawn_scale_;
    look_ = at;
    renderer_->look(std::move(at));
    last_s_ = seconds;
}

bool LiveSource::is_ready()
{
    int warm = 0;
    {
        std::lock_guard const lock(mutex_);
        if (!error_.empty()) throw gi::InputError("a stimulus cannot be rendered", error_, "correct the script");
        if (!place_) return false;
        warm = warm_frames_;
    }
    if (warm > view_.warmup_frames) return true;
    look(0);
    renderer_->again();
    return false;
}

void LiveSource::at(double seconds)
{
    if (seconds >= 0 && last_s_ < 0 && plays_) {
        post({"play", true});
        posted_.play = true;
    }
    if (seconds != last_s_ || view_.on_walls) look(seconds);
}

void LiveSource::change(StimulusSettings const& stimulus)
{
    Settings wanted = stimulus.settings;
    wanted.play = posted_.play;
    post_settings(wanted);
    for (Change const& c : stimulus.edits) post(c);
    edited_ |= !stimulus.edits.empty();
    stimulus_.settings = stimulus.settings;
    if (stimulus.raise_m == stimulus_.raise_m && stimulus.fov_deg == stimulus_.fov_deg) return;
    stimulus_.raise_m = stimulus.raise_m;
    stimulus_.fov_deg = stimulus.fov_deg;
    look(std::max(0.0, last_s_));
}

void LiveSource::walk(NavigationInput const& input, double seconds)
{
    {
        std::lock_guard const lock(mutex_);
        if (!place_) return;
        // Speed as in the viewer: crossing a scene takes seconds, whatever its size.
        if (!navigation_)
            navigation_.emplace(place_->camera.world_from_camera, std::clamp(0.2 * place_->radius_m, 0.05, 20.0),
                                gi::dvec3(place_->camera.world_from_camera[3]));
    }
    navigation_->step(input, seconds);
    look(std::max(0.0, last_s_) + seconds);
}

void LiveSource::rest()
{
    look_ = {};
    renderer_->look({});
    if (posted_.play) post({"play", false}); // clips pause while they are not shown
    posted_.play = false;
    last_s_ = -1;
}

std::shared_ptr<LiveFrame const> LiveSource::newest()
{
    auto frame = renderer_->newest();
    std::lock_guard const lock(mutex_);
    return frame && place_ && frame->begun_s >= settled_s_ ? frame : nullptr;
}

std::optional<FrameCommand> LiveSource::moment(LiveFrame const& frame)
{
    if (!stimulus_.settings.draw_surfaces) return {};
    return moment_at(frame, look_, clock_.now_s(), renderer_->edits_since(frame));
}

} // namespace viewer
