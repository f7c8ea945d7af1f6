#include "viewer/cli/ar/pose_arguments.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

namespace viewer {
namespace {

bool is_nuke(std::string const& file) { return std::filesystem::path(file).extension() == ".chan"; }

/// Poses in millimetres are far away.
void doubt_distance(std::vector<ar::TimedPose> const& poses, std::string const& file, gi::Report& report)
{
    constexpr double kFar_m = 100;
    std::uint64_t n = 0;
    std::string first;
    for (ar::TimedPose const& p : poses)
        if (double const far = glm::length(p.world_from_camera.position); far > kFar_m && n++ == 0)
            first = fmt::format("'{}': {:.4g} m at {:.3f} s; are positions in metres?", file, far, p.time_s);
    if (n > 0)
        report.lose(fmt::format("in doubt: camera poses more than {:g} m from the origin", kFar_m), n, first);
}

std::vector<ar::TimedPose> timed_poses(PoseArguments const& a, ar::Session const& session, char const* hint,
                                       gi::Report& report)
{
    if (a.file.empty()) return {};
    ar::PoseFile poses =
        ar::read_camera_poses(a.file,
                              {ar::frames_per_s_of(session.frames), a.first_frame,
                               is_nuke(a.file) ? ar::rotation_order_named(a.order) : std::nullopt},
                              report);
    if (poses.order && a.order.empty())
        std::fputs(
            fmt::format("lightwell: the angles of '{}' are taken in the rotation order {}, the default of Nuke's "
                        "cameras; if the camera had another: --rotation-order XYZ\n",
                        a.file, name_of(*poses.order))
                .c_str(),
            stderr);
    if (poses.first_frame && !a.first_frame)
        std::fputs(
            fmt::format("lightwell: the first frame is taken for number {:.15g} of '{}' (its first pose); {}\n",
                        *poses.first_frame, a.file, hint)
                .c_str(),
            stderr);
    doubt_distance(poses.poses, a.file, report);
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
    declare_rotation_order(c, a.order);
}

void declare_rotation_order(CLI::App& c, std::string& order)
{
    c.add_option("--rotation-order", order,
                 "Rotation order of the camera in Nuke's files (.chan), which do not say it; default: ZXY, as of "
                 "Nuke's cameras")
        ->check(CLI::IsMember(ar::rotation_order_names()));
}

void check_rotation_order(std::string const& order, std::vector<std::string> const& files)
{
    if (order.empty() || std::any_of(files.begin(), files.end(), is_nuke)) return;
    throw gi::InputError("--rotation-order without poses from Nuke",
                         "only Nuke's files (.chan) have angles that need an order", "leave it out");
}

std::vector<ar::TimedPose> poses_of(PoseArguments const& a, ar::Session const& session, gi::Report& report)
{
    return timed_poses(a, session, "if it is another: --first-pose N", report);
}

std::vector<ar::TimedPose> true_poses_of(std::string const& file, std::string const& order,
                                         ar::Session const& session, gi::Report& report)
{
    return timed_poses({file, {}, order}, session, "if it is another, give the poses times", report);
}

} // namespace viewer
