#include "viewer/devices/tracking/own_avatar.h"

#include "gi/core/error.h"
#include "gi/scene/motion/skinning.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer {
namespace {

constexpr double kBeforeFace_m = 0.02; // distance from the face to the eyes
constexpr float kOfHead = 0.25f;       // skin weight from which a vertex belongs to the head
constexpr double kHangingReach = 0.97; // share of the arm's length; elbows are slightly bent

gi::dvec3 place(gi::Pose const& pose, std::int32_t node) { return pose.world_from_node[std::size_t(node)][3]; }

/// Marks the node and its descendants.
std::vector<bool> below(gi::Scene const& scene, std::int32_t top)
{
    std::vector<bool> is(scene.nodes.size(), false);
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        std::int32_t const parent = scene.nodes[n].parent;
        is[n] = std::int32_t(n) == top || (parent >= 0 && is[std::size_t(parent)]);
    }
    return is;
}

/// Shifts all node numbers of the avatar's joints.
void shift(gi::ArmJoints& arm, std::int32_t by)
{
    for (std::int32_t* j : {&arm.upper, &arm.lower, &arm.hand}) *j += by;
}
void shift(gi::LegJoints& leg, std::int32_t by)
{
    if (leg.foot < 0) return; // no such leg
    for (std::int32_t* j : {&leg.upper, &leg.lower, &leg.foot}) *j += by;
}
void shift(gi::Avatar& avatar, std::int32_t by)
{
    avatar.head += by;
    for (std::int32_t& t : avatar.tops) t += by;
    for (gi::Avatar::Arm* arm : {&avatar.left, &avatar.right}) {
        shift(arm->joints, by);
        for (std::int32_t& w : arm->wrist) w += by;
    }
    shift(avatar.left_leg.joints, by);
    shift(avatar.right_leg.joints, by);
}

/// -1 if it does not exist.
std::int32_t find_root(gi::Scene const& scene, std::string const& name)
{
    for (std::size_t n = scene.nodes.size(); n > 0; --n)
        if (scene.nodes[n - 1].parent < 0 && scene.nodes[n - 1].name == name) return std::int32_t(n - 1);
    return -1;
}

/// Pose of a hanging hand: beside the hip, fingers down, back of the hand outwards.
gi::dmat4 hanging(gi::Avatar::Arm const& arm, gi::Pose const& standing, gi::dvec3 left)
{
    gi::dvec3 const shoulder = place(standing, arm.joints.upper), elbow = place(standing, arm.joints.lower);
    double const length = glm::distance(shoulder, elbow) + glm::distance(elbow, place(standing, arm.joints.hand));
    gi::dvec3 const out = arm.outward * left, up{0, 1, 0};
    gi::dvec3 const way = glm::normalize(gi::dvec3{0, -1, 0} + 0.12 * out);
    return {glm::dvec4(glm::cross(out, up), 0), glm::dvec4(out, 0), glm::dvec4(up, 0),
            glm::dvec4(shoulder + kHangingReach * length * way, 1)};
}

/// Poses legs and back as at the start of an idle clip. The clip does not play,
/// because then the picture would never be still.
void stand_idle(gi::Scene& avatar)
{
    avatar.playbacks.clear();
    for (std::size_t a = 0; a < avatar.animations.size(); ++a) {
        std::string name = avatar.animations[a].name;
        std::transform(name.begin(), name.end(), name.begin(),
                       [](unsigned char c) { return char(std::tolower(c)); });
        if (name.find("idle") == std::string::npos) continue;
        avatar.playbacks.push_back({std::int32_t(a), 0, 0, true});
        return;
    }
}

} // namespace

double reach_before_head_m(gi::Scene const& scene, gi::Avatar const& avatar)
{
    gi::Pose const rest = gi::evaluate_pose(scene, std::nullopt);
    std::vector<bool> const of_head = below(scene, avatar.head);
    gi::dvec3 const joint = place(rest, avatar.head), forward = avatar.world_from_body * gi::dvec3{0, 0, 1};
    double reach = 0;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        for (std::int32_t const m : scene.nodes[n].meshes) {
            gi::Mesh const& mesh = scene.meshes[std::size_t(m)];
            bool const is_skinned = scene.nodes[n].skin >= 0 && !mesh.joints.empty();
            if (!is_skinned && !of_head[n]) continue;
            std::vector<gi::vec3> const at = gi::deform(scene, rest, n, mesh).positions;
            for (std::size_t v = 0; v < at.size(); ++v) {
                float share = is_skinned ? 0.0f : 1.0f;
                for (int k = 0; is_skinned && k < 4; ++k) {
                    std::int32_t const j =
                        scene.skins[std::size_t(scene.nodes[n].skin)].joints[mesh.joints[v][std::size_t(k)]];
                    if (of_head[std::size_t(j)]) share += mesh.weights[v][k];
                }
                if (share >= kOfHead) reach = std::max(reach, glm::dot(gi::dvec3(at[v]) - joint, forward));
            }
        }
    return reach;
}

OwnAvatar::OwnAvatar(gi::Scene avatar, double eye_height_m, std::size_t user,
                     std::optional<gi::AvatarJoints> const& joints)
    : scene_(std::move(avatar)),
      eye_height_m_(eye_height_m),
      user_(user),
      root_(user == 0 ? "user's avatar" : fmt::format("user {}'s avatar", user + 1))
{
    joints_ = joints ? *joints : gi::find_avatar_joints(scene_);
    avatar_ = gi::make_avatar(scene_, joints_);
    for (gi::Node& n : scene_.nodes) n.camera = n.light = -1;
    scene_.cameras.clear();
    scene_.lights.clear();
    scene_.environment.reset();
    stand_idle(scene_);
    // Scale the avatar rather than the user's motion, so that the view is from the avatar's eyes.
    scale_ = 1 / height_scale(scene_, avatar_, eye_height_m, measures_);
    measures_.head_joint_in_head.z = scale_ * reach_before_head_m(scene_, avatar_) + kBeforeFace_m;
    if (avatar_.has_legs()) measure_legs();
}

/// Places the feet side by side below the hips, as far apart as the hips at rest, because models at rest may be in
/// the middle of a step.
void OwnAvatar::measure_legs()
{
    gi::Pose const rest = gi::evaluate_pose(scene_, std::nullopt);
    gi::LegJoints const &left = avatar_.left_leg.joints, &right = avatar_.right_leg.joints;
    auto const in_body = [&](std::int32_t joint) {
        return scale_ * (glm::inverse(avatar_.world_from_body) * (place(rest, joint) - place(rest, avatar_.head)));
    };
    gi::dvec3 const hips = 0.5 * (in_body(left.upper) + in_body(right.upper));
    double const apart = std::max(0.0, in_body(left.upper).x - in_body(right.upper).x);
    double const aside = 0.5 * std::clamp(in_body(left.foot).x - in_body(right.foot).x, apart, 2 * apart);
    double const ankle = std::min(place(rest, left.foot).y, place(rest, right.foot).y) - avatar_.floor_y;
    measures_.left_ankle_in_foot = measures_.right_ankle_in_foot = {0, scale_ * std::max(0.0, ankle), 0};
    // Bodies in the room look along -Z, avatars along +Z.
    stance_ = {measures_.head_joint_in_head, {-hips.x - aside, 0, -hips.z}, {-hips.x + aside, 0, -hips.z}};
}

gi::Scene OwnAvatar::joined(gi::Scene scene) const
{
    std::size_t const root = scene.nodes.size();
    gi::append(scene, scene_, root_, glm::scale(gi::dmat4(1), gi::dvec3(scale_)));
    scene.nodes[root].driven = true;
    return scene;
}

gi::AvatarJoints OwnAvatar::joints_in(gi::Scene const& scene) const
{
    std::int32_t const root = find_root(scene, root_);
    if (root < 0)
        throw gi::InputError("there is no avatar in '" + scene.name + "'", "no avatar was added to it", "add one");
    gi::AvatarJoints joints = joints_;
    joints.head += root + 1;
    shift(joints.left, root + 1);
    shift(joints.right, root + 1);
    shift(joints.left_leg, root + 1);
    shift(joints.right_leg, root + 1);
    return joints;
}

void OwnAvatar::drive(gi::Scene const& scene, FrameCommand const& command, gi::Pose& pose) const
{
    std::int32_t const root = find_root(scene, root_);
    if (root < 0) return;
    gi::Avatar avatar = avatar_;
    shift(avatar, root + 1);
    Tracked tracked;
    if (user_ <= command.others.size()) tracked = user_ == 0 ? command.tracked : command.others[user_ - 1];
    if (!tracked.head) tracked.head = RoomPose{{0, eye_height_m_, 0}, {1, 0, 0, 0}};
    gi::AvatarTargets targets = puppet_targets(tracked, command.world_from_room, measures_);
    if (!targets.left_hand || !targets.right_hand) {
        gi::Pose standing = pose;
        gi::drive(scene, avatar, {targets.head, {}, {}}, standing);
        gi::dvec3 left = place(standing, avatar.left.joints.upper) - place(standing, avatar.right.joints.upper);
        left.y = 0;
        if (glm::length(left) > 0) {
            left = glm::normalize(left);
            if (!targets.left_hand) targets.left_hand = hanging(avatar.left, standing, left);
            if (!targets.right_hand) targets.right_hand = hanging(avatar.right, standing, left);
        }
    }
    gi::drive(scene, avatar, targets, pose);
}

} // namespace viewer
