#include "viewer/devices/tracking/puppet.h"

#include "gi/core/error.h"
#include "gi/core/pose.h"

#include <fmt/format.h>

namespace viewer {
namespace {

/// Rigid pose of a matrix, without its scale.
gi::dmat4 in_world(gi::dmat4 const& world_from_room, RoomPose const& pose)
{
    glm::dmat3 turn(world_from_room);
    for (int c = 0; c < 3; ++c) turn[c] = glm::normalize(turn[c]);
    gi::dmat4 m(turn * glm::mat3_cast(pose.rotation));
    m[3] = world_from_room * glm::dvec4(pose.position, 1);
    return m;
}

} // namespace

double height_scale(gi::Scene const& scene, gi::Avatar const& avatar, double user_eye_height_m,
                    PuppetMeasures const& measures)
{
    if (!(user_eye_height_m >= 0.3 && user_eye_height_m <= 3))
        throw gi::InputError(fmt::format("an eye height of {} m is not understood", user_eye_height_m),
                             "people's are 0.3 to 3 m above the floor", "write it in metres, 1.65");
    gi::Pose const rest = gi::evaluate_pose(scene, std::nullopt);
    double const head = rest.world_from_node[std::size_t(avatar.head)][3].y;
    double const floor = avatar.floor_y;
    double const user_joint_m = user_eye_height_m + measures.head_joint_in_head.y;
    if (!(head > floor) || !(user_joint_m > 0))
        throw gi::InputError("the avatar's head is not above its floor", "it has no height to compare",
                             "stand it upright, with +Y up, on y = 0");
    return (head - floor) / user_joint_m;
}

gi::AvatarTargets puppet_targets(Tracked const& tracked, gi::dmat4 const& world_from_room,
                                 PuppetMeasures const& measures)
{
    gi::AvatarTargets targets;
    double const s = measures.avatar_per_user;
    gi::dvec3 user_joint{0}, joint{0}; // the user's and the avatar's head joint, in the room
    if (tracked.head) {
        user_joint = *tracked.head * measures.head_joint_in_head;
        joint = {user_joint.x, s * user_joint.y, user_joint.z};
        targets.head = in_world(world_from_room, {joint, tracked.head->rotation});
    }
    auto const limb = [&](std::optional<RoomPose> const& pose,
                          RoomPose const& joint_in_body) -> std::optional<gi::dmat4> {
        if (!pose) return std::nullopt;
        RoomPose p = *pose * joint_in_body;
        if (tracked.head)
            p.position = joint + s * (p.position - user_joint);
        else
            p.position.y *= s;
        return in_world(world_from_room, p);
    };
    targets.left_hand = limb(tracked.left_hand, measures.left_wrist_in_hand);
    targets.right_hand = limb(tracked.right_hand, measures.right_wrist_in_hand);
    targets.left_foot = limb(tracked.left_foot, {measures.left_ankle_in_foot, {1, 0, 0, 0}});
    targets.right_foot = limb(tracked.right_foot, {measures.right_ankle_in_foot, {1, 0, 0, 0}});
    return targets;
}

} // namespace viewer
