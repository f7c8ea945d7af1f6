#include "viewer/cli/ar/pose_arguments.h"

#include <cstdio>
#include <fmt/format.h>

namespace viewer {
namespace {

std::vector<ar::TimedPose> timed_poses(PoseArguments const& a, ar::Session const& session, char const* hint,
                                       gi::Report& report)
{
    if (a.file.empty()) return {};
    ar::PoseFile poses =
        ar::read_camera_poses(a.file, {ar::frames_per_s_of(session.frames), a.first_frame}, report);
    if (poses.first_frame && !a.first_frame)
        std::fputs(
            fmt::format("lightwell: the first frame is taken for number {:.15g} of '{}' (its first pose); {}\n",
                        *poses.first_frame, a.file, hint)
                .c_str(),
            stderr);
    return std::move(poses.poses);
}

} // namespace

void declare_poses(CLI::App& c, PoseArguments& a)
{
    CLI::Option* const file = c.add_option(
        "--poses", a.file,
        "Camera poses (CSV, TUM, COLMAP images.txt, Nuke .chan, Blender .json, glTF, FBX, COLLADA), instead of "
        "using the markers");
    c.add_option(
         "--first-pose", a.first_frame,
         "Number that the session's first frame has in the file of --poses, if it numbers frames; default: "
         "that of its first pose")
        ->needs(file)
        ->check(CLI::Range(-1e9, 1e9));
}

std::vector<ar::TimedPose> poses_of(PoseArguments const& a, ar::Session const& session, gi::Report& report)
{
    return timed_poses(a, session, "if it is another: --first-pose N", report);
}

std::vector<ar::TimedPose> true_poses_of(std::string const& file, ar::Session const& session, gi::Report& report)
{
    return timed_poses({file, {}}, session, "if it is another, give the poses times", report);
}

} // namespace viewer
