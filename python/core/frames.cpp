#include "python/core/frames.h"

#include "gi/core/error.h"
#include "viewer/engine/scene_edits.h"
#include "viewer/experiment/stimuli/study_scenes.h"

#include <chrono>

namespace bindings {

Frames::Frames(int threads) : scenes_(viewer::study_scenes()), session_(scenes_.load, threads, report_)
{
    session_.apply({"panel", false});
}

void Frames::set(viewer::Change const& wanted)
{
    std::lock_guard const lock(mutex_);
    viewer::check_offered(session_.settings(), wanted.key);
    change(wanted);
}

void Frames::change(viewer::Change const& change)
{
    session_.apply(change);
    if (change.key == "scene")
        is_edited_ = false;
    else
        is_edited_ = is_edited_ || viewer::is_scene_edit(change.key);
}

nlohmann::json Frames::get(std::string const& key) const
{
    std::lock_guard const lock(mutex_);
    if (key == "scene") return session_.scene_name();
    return viewer::get(session_.settings(), key);
}

gi::Camera Frames::camera(std::string const& name) const
{
    std::lock_guard const lock(mutex_);
    return find_camera(name);
}

gi::Camera Frames::find_camera(std::string const& name) const
{
    if (!session_.has_scene())
        throw gi::InputError("there is no camera", "no scene is loaded",
                             "set one first: frames.set('scene', NAME)");
    return scenes_.camera(session_.world(), name);
}

void Frames::take(viewer::StimulusSettings const& stimulus)
{
    std::lock_guard const lock(mutex_);
    for (viewer::Change const& c : viewer::differences(session_.settings(), stimulus.settings)) change(c);
    // Only reloading the scene undoes edits.
    if (stimulus.scene != session_.scene_name() || is_edited_) change({"scene", stimulus.scene});
    for (viewer::Change const& c : stimulus.edits) change(c);
}

gi::Camera Frames::camera_at(viewer::StimulusSettings const& stimulus, int width, int height, double seconds,
                             double duration_s) const
{
    viewer::StimulusView view;
    view.size_px = {width, height};
    view.duration_s = duration_s;
    std::lock_guard const lock(mutex_);
    auto const place = viewer::place_of(session_.world(), find_camera(stimulus.camera));
    return viewer::stimulus_views(place, stimulus, view, seconds).at(0).camera;
}

MadeFrame Frames::render(std::vector<viewer::ViewCommand> views, FrameWork work, double scene_s,
                         gi::StopRequest const& stop)
{
    if (views.empty())
        throw gi::InputError("the frame has no view", "there is nothing to render", "give at least one");
    std::lock_guard const lock(mutex_);
    viewer::FrameCommand order;
    order.frame = frame_;
    order.scene_s = scene_s;
    order.world_from_room = views[0].camera.world_from_camera;
    order.views = std::move(views);
    double pixels = 0;
    for (viewer::ViewCommand const& v : order.views) pixels += double(v.width) * v.height;
    viewer::FrameBudget const budget =
        work.paths ? viewer::FrameBudget{*work.paths, 1} : governor_.next(pixels, false, {0, 1});
    order.paths = budget.paths;
    check_command(order);
    auto const begun = std::chrono::steady_clock::now();
    MadeFrame made;
    made.frame = session_.render(order, stop);
    made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    made.exposure_ev = session_.settings().exposure_ev;
    made.tone = session_.settings().tone;
    governor_.measured(budget, pixels, made.seconds, 1 / work.budget_s);
    ++frame_;
    return made;
}

} // namespace bindings
