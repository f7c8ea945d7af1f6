#include "gi/scene/motion/avatar.h"

#include "gi/core/error.h"
#include "gi/core/rotation.h"
#include "gi/scene/motion/inverse_kinematics.h"
#include "gi/scene/motion/joint_motion.h"

#include <algorithm>
#include <cmath>

namespace gi {
namespace {

constexpr dvec3 kUp{0, 1, 0};

std::vector<std::int32_t> top_joints(Scene const& scene, std::int32_t head)
{
    std::vector<bool> inside(scene.nodes.size(), false); // joints of its skins and all nodes below them
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
    dvec3 const wrist = joint_position(rest, joints.hand), elbow = joint_position(rest, joints.lower);
    double const near = 0.25 * glm::distance(wrist, elbow);
    dvec3 fingers{0};
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        std::int32_t const parent = scene.nodes[n].parent;
        dvec3 const at = joint_position(rest, std::int32_t(n));
        if (parent == joints.hand) fingers += at - wrist;
        bool const beside = parent == scene.nodes[std::size_t(joints.hand)].parent &&
                            std::int32_t(n) != joints.lower && scene.nodes[n].meshes.empty();
        if (std::int32_t(n) == joints.hand || (beside && glm::distance(at, wrist) <= near))
            arm.wrist.push_back(std::int32_t(n));
    }
    if (glm::length(fingers) < 1e-3 * near) fingers = wrist - elbow;
    // Palms face down when the arms are spread, and face the body when they hang:
    // "up" is then nearly along the fingers.
    dvec3 back = body * dvec3{0.3 * outward, 1, 0};
    if (double const length = glm::length(fingers); length > 0)
        back -= glm::dot(back, fingers) / (length * length) * fingers;
    arm.joint_from_hand = glm::inverse(tracker_orientation(fingers, back)) *
                          orientation_of(rest.world_from_node[std::size_t(joints.hand)]);
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

void drive_head(Scene const& scene, Avatar const& avatar, dmat4 const& target, dquat const& yaw, Pose& pose)
{
    dvec3 const joint = joint_position(pose, avatar.head);
    dmat4 motion = turn_about(joint, yaw);
    motion[3] += glm::dvec4(dvec3(target[3]) - joint, 0);
    move_below(scene, avatar.tops, motion, pose);
    dquat const now = orientation_of(pose.world_from_node[std::size_t(avatar.head)]);
    dquat const turn = orientation_of(target) * avatar.joint_from_head * glm::inverse(now);
    move_below(scene, {avatar.head}, turn_about(joint_position(pose, avatar.head), turn), pose);
}

/// Pole direction of the elbow: down and outwards for a hand in front; for other hand directions, this pole is
/// rotated along by the shortest rotation. So it is undefined only for hands behind the head, whereas a fixed pole
/// would be undefined for two directions, one of them in front of the face.
dvec3 elbow_direction(dvec3 to_hand, double outward, dquat const& body)
{
    dvec3 const front = body * dvec3{0.3 * outward, -0.3, 0.9}, down = body * dvec3{0.4 * outward, -1, 0};
    return turn_between(front, to_hand, down) * down;
}

void drive_arm(Scene const& scene, Avatar::Arm const& arm, dmat4 const& target, dquat const& body, Pose& pose)
{
    ArmJoints const& j = arm.joints;
    dvec3 const goal(target[3]);
    dvec3 const pole = elbow_direction(goal - joint_position(pose, j.upper), arm.outward, body);
    bend_limb(scene, j.upper, j.lower, j.hand, goal, pole, pose);
    dquat const now = orientation_of(pose.world_from_node[std::size_t(j.hand)]);
    dquat const hand = orientation_of(target) * arm.joint_from_hand * glm::inverse(now);
    move_below(scene, arm.wrist, turn_about(joint_position(pose, j.hand), hand), pose);
}

constexpr double kMostRise_rad = 0.9;
constexpr double kBallOfLeg = 0.15; // of the leg's length, in front of the ankle, if there is no toe joint

/// Distance of the ball of the foot in front of the ankle, m.
double ball_distance(Scene const& scene, Pose const& rest, std::int32_t foot, dvec3 forward, double leg_m)
{
    double distance = kBallOfLeg * leg_m;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].parent != foot || !scene.nodes[n].meshes.empty()) continue;
        double const ahead = glm::dot(joint_position(rest, std::int32_t(n)) - joint_position(rest, foot), forward);
        if (ahead > 0.02 * leg_m && ahead < 0.4 * leg_m) distance = ahead;
    }
    return distance;
}

struct Foot {
    dvec3 ankle;
    dquat rotation;
};

/// Smallest rotation about the ball that brings the ankle within `reach_m` of the hip or, if impossible, the one
/// that brings it nearest. With a = ankle - ball and d = hip - ball in the foot's frame, turned by t about its x
/// axis: |d - R(t) a|^2 = d^2 + a^2 - 2 (A cos t + B sin t), A = dy ay + dz az, B = dz ay - dy az.
Foot on_ball(Foot const& flat, dvec3 ball_in_foot, dvec3 hip, double reach_m)
{
    if (glm::distance(hip, flat.ankle) <= reach_m) return flat;
    dvec3 const ball = flat.ankle + flat.rotation * ball_in_foot, a = -ball_in_foot;
    dvec3 const d = glm::inverse(flat.rotation) * (hip - ball);
    double const A = d.y * a.y + d.z * a.z, B = d.z * a.y - d.y * a.z, most = std::hypot(A, B);
    double const least = 0.5 * (glm::dot(d, d) + glm::dot(a, a) - reach_m * reach_m);
    double const nearest = std::atan2(B, A);
    if (!(nearest < 0)) return flat; // only the heel may rise, not the toes
    double const within = least < most ? std::acos(std::max(-1.0, least / most)) : 0;
    dquat const rise = glm::angleAxis(std::max(-kMostRise_rad, nearest + within), dvec3{1, 0, 0});
    return {ball + flat.rotation * (rise * a), flat.rotation * rise};
}

/// Returns no leg (all -1) if there are no joints, a bone has no length, or the ankle is not below the hip.
/// @param avatar  its world_from_body and floor_y must be set
Avatar::Leg make_leg(Scene const& scene, Pose const& rest, LegJoints const& joints, Avatar const& avatar)
{
    if (joints.foot < 0) return {};
    dvec3 const hip = joint_position(rest, joints.upper), knee = joint_position(rest, joints.lower),
                ankle = joint_position(rest, joints.foot);
    double const thigh_m = glm::distance(hip, knee), shin_m = glm::distance(knee, ankle);
    if (!(thigh_m > 0 && shin_m > 0 && hip.y - ankle.y > 0.2 * (thigh_m + shin_m))) return {};
    Avatar::Leg leg;
    leg.joints = joints;
    dvec3 const forward = avatar.world_from_body * dvec3{0, 0, 1};
    leg.joint_from_foot = glm::inverse(tracker_orientation(forward, {0, 1, 0})) *
                          orientation_of(rest.world_from_node[std::size_t(joints.foot)]);
    double const ball_m = ball_distance(scene, rest, joints.foot, forward, thigh_m + shin_m);
    leg.ball_in_foot = dvec3{0, std::min(0.0, avatar.floor_y - ankle.y), -ball_m} / (thigh_m + shin_m);
    return leg;
}

/// Bends the leg with reach() so that the ankle is at its target and the foot has the target's orientation. For a
/// foot below the hip, the knee points forward, between the directions of the body and of the toes. For other foot
/// positions this direction is rotated along, so that it is undefined only for a foot above the hip. If the target
/// is out of reach, the heel rises by up to 0.9 rad about the ball of the foot, which stays in place; if it is
/// still out of reach, the leg is straight and the foot leaves the floor.
/// @param target  rigid, finite  @param body  world from body
void drive_leg(Scene const& scene, Avatar::Leg const& leg, dmat4 const& target, dquat const& body, Pose& pose)
{
    LegJoints const& j = leg.joints;
    dvec3 const hip = joint_position(pose, j.upper), knee = joint_position(pose, j.lower);
    double const length_m = glm::distance(hip, knee) + glm::distance(knee, joint_position(pose, j.foot));
    Foot const foot =
        on_ball({dvec3(target[3]), orientation_of(target)}, length_m * leg.ball_in_foot, hip, length_m);
    dvec3 const toes = orientation_of(target) * dvec3{0, 0, -1}, ahead = body * dvec3{0, 0, 1};
    dvec3 const level{toes.x, 0, toes.z};
    // Toes that point backwards must not turn the knee backwards.
    dvec3 const forward = glm::dot(level, ahead) > -0.5 ? ahead + level : ahead;
    dvec3 const pole = turn_between({0, -1, 0}, foot.ankle - hip, body * dvec3{1, 0, 0}) * forward;
    dvec3 const ankle = bend_limb(scene, j.upper, j.lower, j.foot, foot.ankle, pole, pose);
    dvec3 const from = joint_position(pose, j.foot);
    dquat const now = orientation_of(pose.world_from_node[std::size_t(j.foot)]);
    dmat4 motion = turn_about(from, foot.rotation * leg.joint_from_foot * glm::inverse(now));
    motion[3] += glm::dvec4(ankle - from, 0);
    move_below(scene, {j.foot}, motion, pose);
}

} // namespace

Avatar make_avatar(Scene const& scene, AvatarJoints const& joints)
{
    Pose const rest = evaluate_pose(scene, std::nullopt);
    Avatar avatar;
    avatar.head = joints.head;
    avatar.tops = top_joints(scene, joints.head);
    dvec3 left = joint_position(rest, joints.left.upper) - joint_position(rest, joints.right.upper);
    left.y = 0;
    if (!(glm::length(left) > 0))
        throw InputError("one of the avatar's shoulders is above the other", "its viewing direction is undefined",
                         "stand it upright, with +Y up");
    avatar.world_from_body = orientation_of(left, kUp, 1);
    dvec3 const forward = avatar.world_from_body * dvec3{0, 0, 1};
    avatar.joint_from_head = glm::inverse(tracker_orientation(forward, kUp)) *
                             orientation_of(rest.world_from_node[std::size_t(joints.head)]);
    avatar.left = make_arm(scene, rest, joints.left, 1, avatar.world_from_body);
    avatar.right = make_arm(scene, rest, joints.right, -1, avatar.world_from_body);
    // The floor is y = 0 unless joints lie below; ankles are a little above the soles.
    for (Skin const& skin : scene.skins)
        for (std::int32_t const j : skin.joints)
            avatar.floor_y = std::min(avatar.floor_y, joint_position(rest, j).y);
    avatar.left_leg = make_leg(scene, rest, joints.left_leg, avatar);
    avatar.right_leg = make_leg(scene, rest, joints.right_leg, avatar);
    if (!avatar.has_legs()) avatar.left_leg = avatar.right_leg = {};
    return avatar;
}

void drive(Scene const& scene, Avatar const& avatar, AvatarTargets const& targets, Pose& pose)
{
    dquat body = avatar.world_from_body;
    if (tracked(targets.head)) {
        dquat const yaw =
            turn_between(body * dvec3{0, 0, 1}, heading(orientation_of(*targets.head)), body * dvec3{1, 0, 0});
        drive_head(scene, avatar, *targets.head, yaw, pose);
        body = yaw * body;
    }
    if (avatar.has_legs() && tracked(targets.left_foot))
        drive_leg(scene, avatar.left_leg, *targets.left_foot, body, pose);
    if (avatar.has_legs() && tracked(targets.right_foot))
        drive_leg(scene, avatar.right_leg, *targets.right_foot, body, pose);
    if (tracked(targets.left_hand)) drive_arm(scene, avatar.left, *targets.left_hand, body, pose);
    if (tracked(targets.right_hand)) drive_arm(scene, avatar.right, *targets.right_hand, body, pose);
}

} // namespace gi
