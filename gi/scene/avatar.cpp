#include "gi/scene/avatar.h"

#include "gi/base/error.h"
#include "gi/scene/inverse_kinematics.h"

#include <algorithm>
#include <cmath>

namespace gi {
namespace {

constexpr dvec3 kUp{0, 1, 0};

dvec3 position(Pose const& pose, std::int32_t node) { return dvec3(pose.world_from_node[std::size_t(node)][3]); }

/// x along `x`, y as far towards `y` as can be. Of a transform that mirrors, the mirrored one's; none of one that
/// is flat.
dquat orientation(dvec3 x, dvec3 y, double determinant)
{
    double const sign = determinant < 0 ? -1 : 1;
    dvec3 const z = glm::cross(x, y);
    if (!(glm::length(x) > 0) || !(glm::length(z) > 0)) return {1, 0, 0, 0};
    dvec3 const ux = sign * glm::normalize(x), uz = glm::normalize(z);
    return glm::normalize(glm::quat_cast(glm::dmat3(ux, glm::cross(uz, ux), uz)));
}

dquat orientation(dmat4 const& m)
{
    return orientation(dvec3(m[0]), dvec3(m[1]), glm::determinant(glm::dmat3(m)));
}

/// From the directions of a tracker's -Z and +Y.
dquat tracker_orientation(dvec3 forward, dvec3 up) { return orientation(glm::cross(forward, up), up, 1); }

dmat4 turn_about(dvec3 pivot, dquat const& rotation)
{
    dmat4 m = glm::mat4_cast(rotation);
    m[3] = glm::dvec4(pivot - rotation * pivot, 1);
    return m;
}

/// Nodes and all below them.
void move_below(Scene const& scene, std::vector<std::int32_t> const& roots, dmat4 const& motion, Pose& pose)
{
    std::vector<bool> moves(scene.nodes.size(), false);
    for (std::int32_t const r : roots) moves[std::size_t(r)] = true;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        std::int32_t const parent = scene.nodes[n].parent;
        if (parent >= 0 && moves[std::size_t(parent)]) moves[n] = true;
        if (moves[n]) pose.world_from_node[n] = motion * pose.world_from_node[n];
    }
}

std::vector<std::int32_t> top_joints(Scene const& scene, std::int32_t head)
{
    std::vector<bool> inside(scene.nodes.size(), false); // joints of its skins, and what hangs on them
    inside[std::size_t(head)] = true;
    for (Skin const& s : scene.skins)
        if (std::find(s.joints.begin(), s.joints.end(), head) != s.joints.end())
            for (std::int32_t const j : s.joints) inside[std::size_t(j)] = true;
    std::vector<std::int32_t> tops;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        std::int32_t const parent = scene.nodes[n].parent;
        bool const below = parent >= 0 && inside[std::size_t(parent)];
        if (inside[n] && !below) tops.push_back(std::int32_t(n));
        if (below) inside[n] = true;
    }
    return tops;
}

Avatar::Arm make_arm(Scene const& scene, Pose const& rest, ArmJoints const& joints, double outward,
                     dquat const& body)
{
    Avatar::Arm arm;
    arm.joints = joints;
    arm.outward = outward;
    dvec3 const wrist = position(rest, joints.hand), elbow = position(rest, joints.lower);
    double const near = 0.25 * glm::distance(wrist, elbow);
    dvec3 fingers{0};
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        std::int32_t const parent = scene.nodes[n].parent;
        dvec3 const at = position(rest, std::int32_t(n));
        if (parent == joints.hand) fingers += at - wrist;
        bool const beside = parent == scene.nodes[std::size_t(joints.hand)].parent &&
                            std::int32_t(n) != joints.lower && scene.nodes[n].meshes.empty();
        if (std::int32_t(n) == joints.hand || (beside && glm::distance(at, wrist) <= near))
            arm.wrist.push_back(std::int32_t(n));
    }
    if (glm::length(fingers) < 1e-3 * near) fingers = wrist - elbow;
    // Palms face down where arms are spread, and the body where they hang: there "up" is nearly along the fingers.
    dvec3 back = body * dvec3{0.3 * outward, 1, 0};
    if (double const length = glm::length(fingers); length > 0)
        back -= glm::dot(back, fingers) / (length * length) * fingers;
    arm.joint_from_hand = glm::inverse(tracker_orientation(fingers, back)) *
                          orientation(rest.world_from_node[std::size_t(joints.hand)]);
    return arm;
}

bool tracked(std::optional<dmat4> const& target)
{
    if (!target) return false;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite((*target)[c][r])) return false;
    return true;
}

/// The horizontal direction in which a head looks, also where it looks straight up or down: its top then points
/// backwards or forwards.
dvec3 heading(dquat const& head)
{
    dvec3 const forward = head * dvec3{0, 0, -1}, top = head * kUp;
    return {forward.x - forward.y * top.x, 0, forward.z - forward.y * top.z};
}

void drive_head(Scene const& scene, Avatar const& avatar, dmat4 const& target, dquat const& yaw, Pose& pose)
{
    dvec3 const joint = position(pose, avatar.head);
    dmat4 motion = turn_about(joint, yaw);
    motion[3] += glm::dvec4(dvec3(target[3]) - joint, 0);
    move_below(scene, avatar.tops, motion, pose);
    dquat const now = orientation(pose.world_from_node[std::size_t(avatar.head)]);
    dquat const turn = orientation(target) * avatar.joint_from_head * glm::inverse(now);
    move_below(scene, {avatar.head}, turn_about(position(pose, avatar.head), turn), pose);
}

/// Down and outwards for a hand in front; for others that direction is carried along by the shortest turn. So it
/// is undecided only for hands behind the head, where a fixed pole would be for two directions, one before the
/// face.
dvec3 elbow_direction(dvec3 to_hand, double outward, dquat const& body)
{
    dvec3 const front = body * dvec3{0.3 * outward, -0.3, 0.9}, down = body * dvec3{0.4 * outward, -1, 0};
    return turn_between(front, to_hand, down) * down;
}

void drive_arm(Scene const& scene, Avatar::Arm const& arm, dmat4 const& target, dquat const& body, Pose& pose)
{
    ArmJoints const& j = arm.joints;
    dvec3 const shoulder = position(pose, j.upper);
    double const upper_m = glm::distance(shoulder, position(pose, j.lower));
    double const lower_m = glm::distance(position(pose, j.lower), position(pose, j.hand));
    dvec3 const pole = elbow_direction(dvec3(target[3]) - shoulder, arm.outward, body);
    TwoBones const to = reach(shoulder, upper_m, lower_m, dvec3(target[3]), pole);
    dquat const upper = turn_between(position(pose, j.lower) - shoulder, to.middle - shoulder, pole);
    move_below(scene, {j.upper}, turn_about(shoulder, upper), pose);
    dvec3 const elbow = position(pose, j.lower);
    dquat const lower = turn_between(position(pose, j.hand) - elbow, to.end - elbow, pole);
    move_below(scene, {j.lower}, turn_about(elbow, lower), pose);
    dquat const now = orientation(pose.world_from_node[std::size_t(j.hand)]);
    dquat const hand = orientation(target) * arm.joint_from_hand * glm::inverse(now);
    move_below(scene, arm.wrist, turn_about(position(pose, j.hand), hand), pose);
}

} // namespace

Avatar make_avatar(Scene const& scene, AvatarJoints const& joints)
{
    Pose const rest = evaluate_pose(scene, std::nullopt);
    Avatar avatar;
    avatar.head = joints.head;
    avatar.tops = top_joints(scene, joints.head);
    dvec3 left = position(rest, joints.left.upper) - position(rest, joints.right.upper);
    left.y = 0;
    if (!(glm::length(left) > 0))
        throw InputError("the avatar's shoulders are one above the other", "it is not known where it looks",
                         "stand it upright, with +Y up");
    avatar.world_from_body = orientation(left, kUp, 1);
    dvec3 const forward = avatar.world_from_body * dvec3{0, 0, 1};
    avatar.joint_from_head = glm::inverse(tracker_orientation(forward, kUp)) *
                             orientation(rest.world_from_node[std::size_t(joints.head)]);
    avatar.left = make_arm(scene, rest, joints.left, 1, avatar.world_from_body);
    avatar.right = make_arm(scene, rest, joints.right, -1, avatar.world_from_body);
    return avatar;
}

void drive(Scene const& scene, Avatar const& avatar, AvatarTargets const& targets, Pose& pose)
{
    dquat body = avatar.world_from_body;
    if (tracked(targets.head)) {
        dquat const yaw =
            turn_between(body * dvec3{0, 0, 1}, heading(orientation(*targets.head)), body * dvec3{1, 0, 0});
        drive_head(scene, avatar, *targets.head, yaw, pose);
        body = yaw * body;
    }
    if (tracked(targets.left_hand)) drive_arm(scene, avatar.left, *targets.left_hand, body, pose);
    if (tracked(targets.right_hand)) drive_arm(scene, avatar.right, *targets.right_hand, body, pose);
}

} // namespace gi
