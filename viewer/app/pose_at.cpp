#include "viewer/app/pose_at.h"

namespace viewer {

double scene_time_at(LiveFrame const& f, double now_s)
{
    double const s = f.command.scene_s - f.ahead_s * f.settings.speed;
    return f.settings.play ? s + f.settings.speed * (now_s - f.begun_s) : s;
}

gi::Pose pose_at(LiveFrame const& frame, Viewpoint const& at, DriveBodies const& drive, double now_s)
{
    gi::Scene const& scene = *frame.result.scene->world->scene;
    FrameCommand command = frame.command;
    command.scene_s = scene_time_at(frame, now_s);
    command.world_from_room = at.world_from_room;
    command.tracked = at.tracked;
    command.others = at.others;
    gi::Pose pose = gi::evaluate_pose(scene, command.scene_s);
    place(scene, frame.result.placed, pose);
    if (drive) drive(scene, command, pose);
    return pose;
}

} // namespace viewer
