#include "ar/scene/camera_poses.h"

#include "ar/scene/read_values.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/load.h"
#include "gi/scene/motion/animation.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace ar {
namespace {

bool is_scene(std::filesystem::path const& file)
{
    static std::set<std::string> const kinds{".gltf", ".glb", ".fbx", ".dae"};
    return kinds.contains(gi::lower_extension(file));
}

/// Without its scale; cameras of scenes look along -z with y up, those of frames along z with y down.
gi::RigidPose pose_of(gi::dmat4 const& world_from_node)
{
    gi::dvec3 const z = glm::normalize(gi::dvec3(world_from_node[2]));
    gi::dvec3 const x = glm::normalize(glm::cross(gi::dvec3(world_from_node[1]), z));
    glm::dmat3 const turn(x, -glm::cross(z, x), -z);
    return {gi::dvec3(world_from_node[3]), glm::normalize(glm::quat_cast(turn))};
}

} // namespace

double frames_per_s_of(SessionFrames const& frames)
{
    if (is_device(frames.source)) return frames.options.frames_per_s;
    OpenOptions open = frames.options;
    open.pace = Pace::fastest;
    double const own = open_source(frames.source, open)->description().frames_per_s;
    return own > 0 ? own : frames.options.frames_per_s;
}

PoseFile read_camera_poses(std::filesystem::path const& file, FrameNumbering const& numbering, gi::Report& report)
{
    if (!is_scene(file)) {
        PoseFile poses = read_poses(file, numbering);
        if (poses.order)
            report.count("poses with angles in the order " + name_of(*poses.order), double(poses.poses.size()));
        return poses;
    }
    if (numbering.order)
        throw gi::InputError("a rotation order with '" + file.string() + "'",
                             "only Nuke's files (.chan) have angles that need one", "leave the order out");
    if (numbering.first)
        throw gi::InputError("a number of the first frame with '" + file.string() + "'",
                             "the first key of its camera is the first frame", "leave the number out");
    double const frames_per_s = numbering.frames_per_s;
    gi::Scene const scene = gi::load_scene(file.string(), report);
    std::vector<std::size_t> cameras;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        if (scene.nodes[n].camera >= 0) cameras.push_back(n);
    if (cameras.size() != 1)
        throw gi::InputError(fmt::format("'{}' has {} cameras", file.string(), cameras.size()),
                             "one camera's poses are needed",
                             "export the scene with the one that filmed the frames");
    double duration_s = 0;
    for (gi::Playback const& p : scene.playbacks)
        duration_s = std::max(duration_s, scene.animations[std::size_t(p.animation)].duration_s);
    std::vector<TimedPose> poses;
    auto const frames = std::size_t(std::floor(duration_s * frames_per_s + 1e-6));
    for (std::size_t f = 0; f <= frames; ++f) {
        // A clip that loops is back at its start after its last key.
        double const time_s = double(f) / frames_per_s, at_s = std::min(time_s, std::nexttoward(duration_s, 0.0L));
        gi::Pose const pose = gi::evaluate_pose(scene, at_s);
        poses.push_back({time_s, pose_of(pose.world_from_node[cameras.front()])});
        auto const& p = poses.back().world_from_camera;
        if (!std::isfinite(glm::length(p.position)) || !(std::abs(glm::length(p.rotation) - 1) < 1e-6))
            throw gi::InputError(fmt::format("'{}': the camera at {} s is not finite", file.string(), time_s),
                                 "frames cannot be composited with it", "check the scale of its node");
    }
    return {std::move(poses), {}, {}};
}

} // namespace ar
