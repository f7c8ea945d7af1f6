#include "viewer/app/pose_at.h"

#include "gi/core/error.h"

#include <algorithm>

namespace viewer {
namespace {

/// The rendering thread reports an edit that cannot be made.
template <class Edit>
void if_possible(Edit const& edit)
{
    try {
        edit();
    } catch (gi::InputError const&) {
    }
}

} // namespace

double scene_time_at(LiveFrame const& f, double now_s)
{
    double const s = f.command.scene_s - f.ahead_s * f.settings.speed;
    return f.settings.play ? s + f.settings.speed * (now_s - f.begun_s) : s;
}

FrameCommand moment_at(LiveFrame const& frame, Viewpoint const& at, double now_s, std::vector<Change> edits)
{
    FrameCommand moment = frame.command;
    if (!frame.ordered.empty()) moment.views = frame.ordered;
    moment.changes = std::move(edits);
    moment.scene_s = scene_time_at(frame, now_s);
    moment.pose_s = at.pose_s;
    moment.world_from_room = at.world_from_room;
    moment.tracked = at.tracked;
    moment.others = at.others;
    if (at.views.size() == moment.views.size())
        for (std::size_t k = 0; k < at.views.size(); ++k) moment.views[k].camera = at.views[k].camera;
    return moment;
}

double drawing_pause_s(std::vector<Change> const& edits, bool in_software, double drawing_s)
{
    constexpr double kMoves_s = 0.055;
    if (!in_software || edits.empty()) return 0;
    return std::ranges::any_of(edits, is_light_edit, &Change::key)
               ? drawing_s
               : std::clamp(kMoves_s - drawing_s, 0.0, drawing_s);
}

bool look_same(LiveFrame const& frame, FrameCommand const& a, FrameCommand const& b)
{
    bool const can_move = frame.result.scene && !frame.result.scene->moving->instances.empty();
    return std::ranges::equal(a.views, b.views, {}, &ViewCommand::camera, &ViewCommand::camera) &&
           a.changes == b.changes && a.world_from_room == b.world_from_room &&
           (!can_move || (a.scene_s == b.scene_s && a.tracked == b.tracked && a.others == b.others));
}

gi::Pose pose_at(SessionFrame const& frame, FrameCommand const& moment, DriveBodies const& drive)
{
    gi::Scene const& scene = *frame.scene->world->scene;
    gi::Pose pose = gi::evaluate_pose(scene, moment.scene_s);
    std::vector<PlacedObject> placed = frame.placed;
    place(scene, placed, pose);
    for (Change const& c : moment.changes)
        if (is_object_edit(c.key))
            if_possible([&] {
                PlacedObject const object = placed_object(scene, pose, placed, c);
                std::erase_if(placed, [&](PlacedObject const& p) { return p.node == object.node; });
                placed.push_back(object);
                place(scene, {object}, pose);
            });
    if (drive) drive(scene, moment, pose);
    return pose;
}

std::vector<gi::Light> lights_at(SessionFrame const& frame, FrameCommand const& moment)
{
    gi::ShownScene const& scene = *frame.scene;
    std::vector<gi::Light> lights = scene.lights;
    for (Change const& c : moment.changes)
        if (is_light_edit(c.key) && !lights.empty())
            if_possible([&] { edit_lights(lights, c, scene.authored_intensities, scene.world->origin); });
    if (frame.headlight && !lights.empty() && !moment.views.empty())
        lights.back() = light_at(*frame.headlight, eye_of(moment.views), scene.world->origin);
    return lights;
}

} // namespace viewer
