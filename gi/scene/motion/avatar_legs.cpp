#include "gi/scene/motion/avatar_legs.h"

#include "gi/scene/motion/inverse_kinematics.h"
#include "gi/scene/motion/joint_motion.h"

#include <algorithm>
#include <cmath>

namespace gi {
namespace {

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

} // namespace

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

} // namespace gi
