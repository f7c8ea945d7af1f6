#include "viewer/app/pose_at.h"

namespace viewer {

double scene_time_at(LiveFrame const& f, double now_s)
{
    double const s = f.command.scene_s - f.ahead_s * f.settings.speed;
    return f.settings.play ? s + f.settings.speed * (now_s - f.begun_s) : s;
}

FrameCommand moment_at(LiveFrame const& frame, Viewpoint const& at, double now_s)
{
    FrameCommand moment = frame.command;
    moment.changes.clear();
    moment.scene_s = scene_time_at(frame, now_s);
    moment.pose_s = at.pose_s;
    moment.world_from_room = at.world_from_room;
    moment.tracked = at.tracked;
    moment.others = at.others;
    if (at.views.size() == moment.views.size())
        for (std::size_t k = 0; k < at.views.size(); ++k) moment.views[k].camera = at.views[k].camera;
    return moment;
}

gi::Pose pose_at(SessionFrame const& frame, FrameCommand const& moment, DriveBodies const& drive)
{
    gi::Scene const& scene = *frame.scene->world->scene;
    gi::Pose pose = gi::evaluate_pose(scene, moment.scene_s);
    place(scene, frame.placed, pose);
    if (drive) drive(scene, moment, pose);
    return pose;
}

} // namespace viewer
