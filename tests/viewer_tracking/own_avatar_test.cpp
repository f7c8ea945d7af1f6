// A user's avatar in a scene: its head and hands are where the trackers are,
// and it never stands in its user's view.

#include "gi/core/pose.h"
#include "viewer/devices/tracking/own_avatar.h"

#include "gi/core/error.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/load/load.h"
#include "gi/scene/motion/skinning.h"
#include "tests/support/data.h"
#include "tests/viewer_tracking/pose_checks.h"
#include "viewer/devices/tracking/footsteps.h"
#include "viewer/devices/tracking/key_hands.h"
#include "viewer/devices/tracking/known_walk.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using gi::dvec3;

gi::Scene scene_called(std::string const& name)
{
    gi::Report report;
    return name == "avatar" ? gi::generate_avatar()
                            : gi::load_scene((gi::test::shared_data() / "avatars" / name).string(), report);
}

struct Driven {
    OwnAvatar avatar;
    gi::Scene scene;
    gi::AvatarJoints joints;
    gi::Pose pose;

    explicit Driven(std::string const& name, double eye_height_m = 1.65)
        : avatar(scene_called(name), eye_height_m),
          scene(avatar.joined(gi::generate_cornell())),
          joints(avatar.joints_in(scene))
    {
    }
    void to(Tracked const& tracked, gi::dmat4 const& world_from_room = gi::dmat4(1))
    {
        pose = gi::evaluate_pose(scene, 0);
        FrameCommand command;
        command.tracked = tracked;
        command.world_from_room = world_from_room;
        avatar.drive(scene, command, pose);
    }
    dvec3 at(std::int32_t joint) const { return pose.world_from_node[std::size_t(joint)][3]; }
    /// How far a hand can be from its shoulder, and how near.
    std::pair<double, double> reach(gi::ArmJoints const& arm) const
    {
        double const upper = glm::distance(at(arm.upper), at(arm.lower)),
                     lower = glm::distance(at(arm.lower), at(arm.hand));
        return {upper + lower, std::abs(upper - lower)};
    }
    struct Vertex {
        dvec3 place;
        bool of_head; ///< mostly
    };
    std::vector<Vertex> vertices() const
    {
        std::vector<bool> head(scene.nodes.size(), false);
        for (std::size_t n = 0; n < head.size(); ++n)
            head[n] = std::int32_t(n) == joints.head ||
                      (scene.nodes[n].parent >= 0 && head[std::size_t(scene.nodes[n].parent)]);
        std::vector<Vertex> all;
        for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
            gi::Node const& node = scene.nodes[n];
            for (std::int32_t const m : node.meshes) {
                gi::Mesh const& mesh = scene.meshes[std::size_t(m)];
                bool const skinned = node.skin >= 0 && !mesh.joints.empty();
                if (!skinned && !head[n]) continue; // of the room
                auto const places = gi::deform(scene, pose, n, mesh).positions;
                for (std::size_t v = 0; v < places.size(); ++v) {
                    float share = skinned ? 0.0f : 1.0f;
                    for (int k = 0; skinned && k < 4; ++k)
                        if (head[std::size_t(
                                scene.skins[std::size_t(node.skin)].joints[mesh.joints[v][std::size_t(k)]])])
                            share += mesh.weights[v][k];
                    all.push_back({dvec3(places[v]), share > 0.5f});
                }
            }
        }
        return all;
    }
};

gi::dmat4 elsewhere()
{
    gi::dmat4 world = glm::mat4_cast(gi::exp_rotation({0, 1.1, 0}));
    world[3] = {3, 0.4, -2, 1};
    return world;
}

void expect_follows(std::string const& name)
{
    SCOPED_TRACE(name);
    Driven d(name);
    PuppetMeasures const& m = d.avatar.measures();
    int reached = 0, stretched = 0;
    for (int i = 0; i < 200; ++i) {
        Tracked const t = known_walk(i * 0.07);
        d.to(t, elsewhere());
        dvec3 const joint = *t.head * m.head_joint_in_head;
        EXPECT_LT(glm::distance(d.at(d.joints.head), dvec3(elsewhere() * glm::dvec4(joint, 1))), 1e-3) << i;
        gi::AvatarTargets const targets = puppet_targets(t, elsewhere(), m);
        for (auto const& [arm, target] :
             {std::pair{d.joints.left, targets.left_hand}, {d.joints.right, targets.right_hand}}) {
            dvec3 const goal((*target)[3]);
            auto const [most, least] = d.reach(arm);
            double const far = glm::distance(d.at(arm.upper), goal);
            // As near as an arm of its length comes.
            EXPECT_NEAR(glm::distance(d.at(arm.hand), goal), std::max({0.0, far - most, least - far}), 1e-3) << i;
            ++(far <= most && far >= least ? reached : stretched);
        }
    }
    EXPECT_GT(reached, 100) << "and " << stretched << " out of reach";
}

/// Standing upright its soles are on the floor, and it is as tall as its user.
void expect_stands(std::string const& name)
{
    SCOPED_TRACE(name);
    for (double const eyes_m : {1.2, 1.8}) {
        Driven d(name, eyes_m);
        Tracked t;
        t.head = RoomPose{{0, eyes_m, 0}, {1, 0, 0, 0}};
        d.to(t, elsewhere());
        double low = 1e9, high = -1e9;
        for (Driven::Vertex const& v : d.vertices()) {
            low = std::min(low, v.place.y);
            high = std::max(high, v.place.y);
        }
        double const floor = elsewhere()[3].y;
        EXPECT_NEAR(low, floor, 0.06 * eyes_m);
        EXPECT_GT(high, floor + eyes_m);
        EXPECT_LT(high, floor + 1.5 * eyes_m);
    }
}

/// Whatever way the head is held: nothing of it comes before the plane of the eyes, and nothing of the body, whose
/// arms hang, into the middle of the view.
void expect_clear_view(std::string const& name)
{
    SCOPED_TRACE(name);
    Driven d(name);
    for (double const yaw : {0.0, 2.0, 4.0})
        for (double const pitch : {-0.6, 0.0, 0.6})
            for (double const roll : {-0.3, 0.3}) {
                RoomPose const head{{0.4, 1.6, -0.2},
                                    gi::exp_rotation({0, yaw, 0}) * gi::exp_rotation({pitch, 0, 0}) *
                                        gi::exp_rotation({0, 0, roll})};
                Tracked t;
                t.head = head;
                d.to(t, elsewhere());
                gi::dmat4 const eye_from_world = glm::inverse(elsewhere() * to_matrix(head));
                double foremost = -1e9;
                for (Driven::Vertex const& v : d.vertices()) {
                    dvec3 const p(eye_from_world * glm::dvec4(v.place, 1));
                    if (v.of_head) foremost = std::max(foremost, -p.z);
                    if (glm::length(p) < 0.3) {
                        EXPECT_GT(p.z, -0.7 * glm::length(p)) << "a vertex before the eyes";
                    }
                }
                EXPECT_LT(foremost, -0.015) << yaw << " " << pitch << " " << roll;
                EXPECT_GT(foremost, -0.025) << "no farther behind than it need be";
            }
}

void expect_hanging_arms(std::string const& name)
{
    SCOPED_TRACE(name);
    Driven d(name);
    Tracked t;
    t.head = RoomPose{{0, 1.65, 0}, gi::exp_rotation({0, 0.8, 0})};
    d.to(t, elsewhere());
    for (gi::ArmJoints const& arm : {d.joints.left, d.joints.right})
        EXPECT_LT(d.at(arm.hand).y, d.at(arm.upper).y - 0.9 * d.reach(arm).first);
    EXPECT_GT(glm::distance(d.at(d.joints.left.hand), d.at(d.joints.right.hand)),
              glm::distance(d.at(d.joints.left.upper), d.at(d.joints.right.upper)));
}

/// Walking, crouching and both: ankles where the feet are, as near as legs come, and nothing below the floor.
void expect_walks(std::string const& name)
{
    SCOPED_TRACE(name);
    Driven d(name);
    ASSERT_TRUE(d.avatar.stance());
    Footsteps feet(*d.avatar.stance());
    int reached = 0, lifted = 0;
    double lowest = 0;
    for (int i = 0; i < 300; ++i) {
        double const t = 0.03 * i;
        Tracked user;
        user.head =
            RoomPose{{0.3, 1.65 - 0.25 * (1 - std::cos(0.7 * t)), -0.8 * t}, gi::exp_rotation({0, 0.3 * t, 0})};
        feet.step(user, elsewhere(), 0.03);
        d.to(user, elsewhere());
        gi::AvatarTargets const targets = puppet_targets(user, elsewhere(), d.avatar.measures());
        for (auto const& [leg, target] :
             {std::pair{d.joints.left_leg, targets.left_foot}, {d.joints.right_leg, targets.right_foot}}) {
            double const upper = glm::distance(d.at(leg.upper), d.at(leg.lower)),
                         lower = glm::distance(d.at(leg.lower), d.at(leg.foot));
            dvec3 const goal((*target)[3]);
            if (glm::distance(d.at(leg.upper), goal) < upper + lower) {
                EXPECT_LT(glm::distance(d.at(leg.foot), goal), 1e-3) << i;
                ++reached;
            } else {
                ++lifted;
            }
        }
        if (i % 20 == 0)
            for (Driven::Vertex const& v : d.vertices()) lowest = std::min(lowest, v.place.y - elsewhere()[3].y);
    }
    EXPECT_GT(reached, 2 * lifted) << "heels rise at the end of a step";
    if (name != "robot_expressive.glb") { // whose hands hang to the floor
        EXPECT_GT(lowest, -0.08) << "toes of a foot that swings point down";
    }
}

void expect_crouches(std::string const& name)
{
    SCOPED_TRACE(name);
    Driven d(name);
    Footsteps feet(*d.avatar.stance());
    Tracked user;
    user.head = RoomPose{{0, 1.65, 0}, {1, 0, 0, 0}};
    feet.step(user, gi::dmat4(1), 0.01);
    d.to(user);
    double const knee = d.at(d.joints.left_leg.lower).z, hip = d.at(d.joints.left_leg.upper).y;
    user.head->position.y = 1.2;
    feet.step(user, gi::dmat4(1), 0.5);
    d.to(user);
    for (gi::LegJoints const& leg : {d.joints.left_leg, d.joints.right_leg}) {
        EXPECT_NEAR(d.at(leg.upper).y, hip - 0.45, 0.02);
        EXPECT_LT(d.at(leg.lower).z, knee - 0.1) << "knees forward, which is -Z";
        EXPECT_LT(std::abs(d.at(leg.lower).x), 0.35) << "and not apart";
    }
    double lowest = 1;
    for (Driven::Vertex const& v : d.vertices()) lowest = std::min(lowest, v.place.y);
    if (name != "robot_expressive.glb") { // whose hands hang to the floor
        EXPECT_NEAR(lowest, 0, 0.04) << "soles on the floor";
    }
}

void expect_all(std::string const& name)
{
    expect_walks(name);
    expect_crouches(name);
    expect_follows(name);
    expect_stands(name);
    expect_clear_view(name);
    expect_hanging_arms(name);
}

TEST(OwnAvatar, TheGeneratedOne) { expect_all("avatar"); }

TEST(OwnAvatar, QuaterniusHuman)
{
    LIGHTWELL_NEED_DATA("avatars/quaternius_human.glb");
    expect_all("quaternius_human.glb");
}

TEST(OwnAvatar, RobotExpressive)
{
    LIGHTWELL_NEED_DATA("avatars/robot_expressive.glb");
    expect_all("robot_expressive.glb");
}

/// Its arms hang at rest, where the back of the hand is not simply up.
TEST(OwnAvatar, FingersPointWhereTheirTrackersDo)
{
    Driven d("avatar");
    auto const fingers = [&](std::int32_t hand) {
        dvec3 tip{0};
        double weight = 0;
        for (std::size_t n = 0; n < d.scene.nodes.size(); ++n)
            for (std::int32_t const m : d.scene.nodes[n].meshes) {
                gi::Mesh const& mesh = d.scene.meshes[std::size_t(m)];
                auto const places = gi::deform(d.scene, d.pose, n, mesh).positions;
                for (std::size_t v = 0; v < mesh.joints.size(); ++v) {
                    gi::Skin const& skin = d.scene.skins[std::size_t(d.scene.nodes[n].skin)];
                    if (skin.joints[mesh.joints[v][0]] != hand) continue;
                    tip += double(mesh.weights[v][0]) * dvec3(places[v]);
                    weight += double(mesh.weights[v][0]);
                }
            }
        return glm::normalize(tip / weight - d.at(hand));
    };
    Tracked t;
    t.head = RoomPose{{0, 1.65, 0}, {1, 0, 0, 0}};
    for (dvec3 const turn : {dvec3{0, 0, 0}, dvec3{1.5, 0, 0}, dvec3{-1.5, 0, 0}, dvec3{0.4, -0.9, 0.7}}) {
        t.left_hand = RoomPose{{-0.3, 1.2, -0.3}, gi::exp_rotation(turn)};
        t.right_hand = RoomPose{{0.3, 1.2, -0.3}, gi::exp_rotation(turn)};
        d.to(t);
        for (std::int32_t const hand : {d.joints.left.hand, d.joints.right.hand})
            EXPECT_GT(glm::dot(fingers(hand), gi::exp_rotation(turn) * dvec3{0, 0, -1}), 0.9);
    }
}

TEST(OwnAvatar, ALostHeadStandsInTheMiddleOfTheRoom)
{
    Driven d("avatar", 1.7);
    d.to({}, elsewhere());
    dvec3 const joint = dvec3{0, 1.7, 0} + d.avatar.measures().head_joint_in_head;
    EXPECT_LT(glm::distance(d.at(d.joints.head), dvec3(elsewhere() * glm::dvec4(joint, 1))), 1e-9);
}

TEST(OwnAvatar, OtherScenesAreLeftAsTheyAre)
{
    Driven const d("avatar");
    gi::Scene const room = gi::generate_cornell();
    gi::Pose const rest = gi::evaluate_pose(room, 0);
    gi::Pose pose = rest;
    d.avatar.drive(room, {}, pose);
    EXPECT_EQ(pose.world_from_node, rest.world_from_node);
    EXPECT_THROW(d.avatar.joints_in(room), gi::InputError);
}

TEST(OwnAvatar, BringsNoLightsCamerasAndMarches)
{
    gi::Scene lit = gi::generate_avatar();
    lit.nodes[0].light = 0;
    lit.lights.emplace_back();
    lit.nodes[0].camera = 0;
    lit.cameras.emplace_back();
    lit.environment.emplace();
    gi::Scene const room = gi::generate_cornell();
    gi::Scene const joined = OwnAvatar(lit, 1.6).joined(room);
    EXPECT_EQ(joined.lights.size(), room.lights.size());
    EXPECT_EQ(joined.cameras.size(), room.cameras.size());
    EXPECT_FALSE(joined.environment.has_value());
    EXPECT_TRUE(joined.playbacks.empty());
    EXPECT_GT(joined.meshes.size(), room.meshes.size());
}

/// Two users, each with his own: nobody moves another's.
TEST(OwnAvatar, EveryUserMovesHisOwn)
{
    OwnAvatar const first(gi::generate_avatar(), 1.6), third(gi::generate_avatar(), 1.8, 2);
    gi::Scene const scene = third.joined(first.joined(gi::generate_cornell()));
    std::int32_t const heads[2] = {first.joints_in(scene).head, third.joints_in(scene).head};
    EXPECT_NE(heads[0], heads[1]);
    FrameCommand command;
    command.tracked.head = RoomPose{{0.5, 1.6, 0}, {1, 0, 0, 0}};
    command.others.resize(2);
    command.others[1].head = RoomPose{{-0.5, 1.5, 0.3}, gi::exp_rotation({0, 1, 0})};
    command.others[1].left_foot = RoomPose{{-0.6, 0, 0.3}, {1, 0, 0, 0}};
    gi::Pose pose = gi::evaluate_pose(scene, 0);
    first.drive(scene, command, pose);
    third.drive(scene, command, pose);
    for (auto const& [avatar, user, head] :
         {std::tuple{&first, &command.tracked, heads[0]}, {&third, &command.others[1], heads[1]}}) {
        dvec3 const joint = *user->head * avatar->measures().head_joint_in_head;
        EXPECT_LT(glm::distance(dvec3(pose.world_from_node[std::size_t(head)][3]), joint), 1e-9);
    }
    std::int32_t const foot = third.joints_in(scene).left_leg.foot;
    EXPECT_NEAR(pose.world_from_node[std::size_t(foot)][3].x, -0.6, 1e-6);
    command.others.clear();
    pose = gi::evaluate_pose(scene, 0);
    third.drive(scene, command, pose);
    EXPECT_NEAR(pose.world_from_node[std::size_t(heads[1])][3].x, 0, 1e-9) << "in the middle";
}

TEST(OwnAvatar, ModelsWithoutABodyAreRefused)
{
    EXPECT_THROW(OwnAvatar(gi::generate_cornell(), 1.6), gi::InputError);
    for (double const h : {0.0, -1.0, 165.0, double(NAN)})
        EXPECT_THROW(OwnAvatar(gi::generate_avatar(), h), gi::InputError) << h;
}

TEST(KeyHands, RiseWhileTheyAreHeldAndSinkAgain)
{
    RoomPose const head{{0.2, 1.6, 0.1}, gi::exp_rotation({0, 0.7, 0}) * gi::exp_rotation({-0.5, 0, 0})};
    KeyHands hands;
    Tracked const down = hands.with_head(head);
    EXPECT_EQ(down.head, head);
    EXPECT_LT(down.left_hand->position.y, 1.0);
    Tracked before = down;
    for (int i = 0; i < 70; ++i) {
        hands.step(false, true, 0.01);
        Tracked const now = hands.with_head(head);
        EXPECT_EQ(now.left_hand, down.left_hand);
        EXPECT_LT(glm::distance(now.right_hand->position, before.right_hand->position), 0.05);
        EXPECT_LT(angle_between(now.right_hand->rotation, before.right_hand->rotation), 0.15);
        before = now;
    }
    EXPECT_GT(before.right_hand->position.y, 1.6);
    // To the right of the way it faces, however the head nods.
    dvec3 const side = gi::exp_rotation({0, 0.7, 0}) * dvec3{1, 0, 0};
    EXPECT_GT(glm::dot(before.right_hand->position - head.position, side), 0.2);
    EXPECT_LT(glm::dot(before.left_hand->position - head.position, side), -0.2);
    hands.step(false, false, 5);
    EXPECT_EQ(hands.with_head(head), down);
}

} // namespace
} // namespace viewer::test
