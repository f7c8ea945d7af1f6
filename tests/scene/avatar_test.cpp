// Avatars driven by trackers: joints found by their names, heads and hands where they are told.

#include "gi/base/error.h"
#include "gi/scene/avatar.h"
#include "gi/scene/load.h"
#include "tests/support/data.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>

namespace gi::test {
namespace {

/// A standing figure in T-pose, facing +Z: hips, head, two arms of 0.3 + 0.25 m. Names in the order of `names`.
struct Figure {
    static constexpr int kHips = 1, kHead = 2, kLeftHand = 5, kRightHand = 8;
    Scene scene;

    explicit Figure(std::vector<std::string> const& names)
    {
        auto const add = [&](std::int32_t parent, dvec3 translation, dquat rotation = {1, 0, 0, 0}) {
            Node n;
            n.parent = parent;
            n.translation = translation;
            n.rotation = rotation;
            std::size_t const i = scene.nodes.size();
            n.name = i == 0 ? "root" : i <= names.size() ? names[i - 1] : "tip";
            scene.nodes.push_back(n);
        };
        dquat const twist = glm::angleAxis(0.7, glm::normalize(dvec3{1, 2, 3}));
        add(-1, {0, 0, 0});
        add(0, {0, 1, 0});                                        // 1 hips
        add(1, {0, 0.6, 0}, twist);                               // 2 head, with axes of its own
        add(1, {0.2, 0.5, 0});                                    // 3 left arm
        add(3, {0.3, 0, 0}, glm::angleAxis(0.2, dvec3{0, 1, 0})); // 4, bent a little
        add(4, {0.25, 0, 0}, twist);                              // 5
        add(1, {-0.2, 0.5, 0});                                   // 6 right arm
        add(6, {-0.3, 0, 0}, glm::angleAxis(-0.2, dvec3{0, 1, 0}));
        add(7, {-0.25, 0, 0}, glm::inverse(twist)); // 8
        Skin skin;
        skin.joints = {1, 2, 3, 4, 5, 6, 7, 8};
        skin.inverse_bind.assign(8, mat4(1));
        scene.skins = {skin};
    }
};

std::vector<std::string> const kMixamo{"mixamorig:Hips",         "mixamorig:Head",     "mixamorig:LeftArm",
                                       "mixamorig:LeftForeArm",  "mixamorig:LeftHand", "mixamorig:RightArm",
                                       "mixamorig:RightForeArm", "mixamorig:RightHand"};

/// The same with legs of 0.5 + 0.45 m that hang straight, feet at 0.05 m; the right foot below its shin or, as in
/// rigs with controls, below the root.
struct Walker : Figure {
    static constexpr int kLeftFoot = 11, kRightFoot = 14;

    explicit Walker(std::vector<std::string> const& names, bool has_controls = false) : Figure(kMixamo)
    {
        dquat const twist = glm::angleAxis(0.4, glm::normalize(dvec3{2, -1, 1}));
        auto const add = [&](std::int32_t parent, dvec3 translation, dquat rotation = {1, 0, 0, 0}) {
            Node n;
            n.parent = parent;
            n.translation = translation;
            n.rotation = rotation;
            n.name = names[scene.nodes.size() - 9];
            scene.skins[0].joints.push_back(std::int32_t(scene.nodes.size()));
            scene.skins[0].inverse_bind.emplace_back(1);
            scene.nodes.push_back(n);
        };
        add(1, {0.1, 0, 0}); // 9 left thigh
        add(9, {0, -0.5, 0});
        add(10, {0, -0.45, 0}, twist); // 11
        add(1, {-0.1, 0, 0});          // 12 right thigh
        add(12, {0, -0.5, 0}, twist);
        if (has_controls)
            add(0, {-0.1, 0.05, 0}, twist); // 14
        else
            add(13, glm::inverse(twist) * dvec3{0, -0.45, 0});
    }
};

std::vector<std::string> const kMixamoLegs{"mixamorig:LeftUpLeg",  "mixamorig:LeftLeg",  "mixamorig:LeftFoot",
                                           "mixamorig:RightUpLeg", "mixamorig:RightLeg", "mixamorig:RightFoot"};

dmat4 rigid(dvec3 position, dquat const& rotation)
{
    dmat4 m = glm::mat4_cast(rotation);
    m[3] = glm::dvec4(position, 1);
    return m;
}

dvec3 place(Pose const& pose, std::int32_t node) { return dvec3(pose.world_from_node[std::size_t(node)][3]); }

TEST(AvatarJoints, CommonNamesAreFound)
{
    std::vector<std::vector<std::string>> const skeletons{
        kMixamo,
        {"Hips", "Head", "LeftArm", "LeftForeArm", "LeftHand", "RightArm", "RightForeArm", "RightHand"},
        {"Body", "Head", "UpperArm.L", "LowerArm.L", "Palm2.L", "UpperArm.R", "LowerArm.R", "Palm2.R"},
        {"DEF-spine", "DEF-head", "DEF-upper_arm.L", "DEF-forearm.L", "DEF-hand.L", "DEF-upper_arm.R",
         "DEF-forearm.R", "DEF-hand.R"},
        {"pelvis", "head", "upperarm_l", "lowerarm_l", "hand_l", "upperarm_r", "lowerarm_r", "hand_r"},
        {"J_Bip_C_Hips", "J_Bip_C_Head", "J_Bip_L_UpperArm", "J_Bip_L_LowerArm", "J_Bip_L_Hand",
         "J_Bip_R_UpperArm", "J_Bip_R_LowerArm", "J_Bip_R_Hand"},
        {"Bip01", "Bip01 Head", "Bip01 L UpperArm", "Bip01 L Forearm", "Bip01 L Hand", "Bip01 R UpperArm",
         "Bip01 R Forearm", "Bip01 R Hand"},
        {"b_Root_00", "b_Head_05", "b_LeftUpperArm_09", "b_LeftForeArm_010", "b_LeftHand_011",
         "b_RightUpperArm_06", "b_RightForeArm_07", "b_RightHand_08"},
        {"Skeleton_torso_joint_1", "Skeleton_neck_joint_2", "Skeleton_arm_joint_L__4_", "Skeleton_arm_joint_L__3_",
         "Skeleton_arm_joint_L__2_", "Skeleton_arm_joint_R", "Skeleton_arm_joint_R__2_",
         "Skeleton_arm_joint_R__3_"},
        {"hip", "head", "left_shoulder", "left_elbow", "left_wrist", "right_shoulder", "right_elbow",
         "right_wrist"}};
    for (auto const& names : skeletons) {
        Figure const f(names);
        AvatarJoints const j = find_avatar_joints(f.scene);
        EXPECT_EQ(j.head, 2) << names[1];
        EXPECT_EQ(j.left.upper, 3) << names[2];
        EXPECT_EQ(j.left.lower, 4) << names[3];
        EXPECT_EQ(j.left.hand, 5) << names[4];
        EXPECT_EQ(j.right.upper, 6) << names[5];
        EXPECT_EQ(j.right.lower, 7) << names[6];
        EXPECT_EQ(j.right.hand, 8) << names[7];
    }
    Figure const f(kMixamo);
    EXPECT_NE(describe(f.scene, find_avatar_joints(f.scene)).find("mixamorig:LeftArm > mixamorig:LeftForeArm"),
              std::string::npos);
}

TEST(AvatarJoints, AShoulderBeforeTheArmIsTheCollarBone)
{
    Figure f(kMixamo);
    f.scene.nodes[1].name = "LeftShoulder";
    EXPECT_EQ(find_avatar_joints(f.scene).left.upper, 3);
}

TEST(AvatarJoints, WhatIsMissingIsToldAndNamesHelp)
{
    Figure const f({"a", "b", "c", "d", "e", "f", "g", "h"});
    auto const message = [&](AvatarNames const& names) -> std::string {
        try {
            find_avatar_joints(f.scene, names);
        } catch (InputError const& e) {
            return e.what();
        }
        return "found";
    };
    std::string const all = message({});
    for (char const* part : {"no head, left upper arm", "right hand", "there are: a, b, c"})
        EXPECT_NE(all.find(part), std::string::npos) << all;
    EXPECT_EQ(message({"b", {"c", "d", "e"}, {"f", "g", "h"}}), "found");
    EXPECT_EQ(message({"b", {"c", "", ""}, {"f", "", ""}}), "found") << "the only joint below";
    EXPECT_NE(message({"nose", {}, {}}).find("'nose'"), std::string::npos);
    EXPECT_NE(message({"b", {"c", "e", "d"}, {"f", "g", "h"}}).find("not below"), std::string::npos);
    Scene bare;
    EXPECT_THROW(find_avatar_joints(bare), InputError);
}

TEST(AvatarJoints, CommonNamesOfLegsAreFound)
{
    std::vector<std::vector<std::string>> const skeletons{
        kMixamoLegs,
        {"LeftUpLeg", "LeftLeg", "LeftFoot", "RightUpLeg", "RightLeg", "RightFoot"},
        {"UpperLeg.L", "LowerLeg.L", "Foot.L", "UpperLeg.R", "LowerLeg.R", "Foot.R"},
        {"DEF-thigh.L", "DEF-shin.L", "DEF-foot.L", "DEF-thigh.R", "DEF-shin.R", "DEF-foot.R"},
        {"thigh_l", "calf_l", "foot_l", "thigh_r", "calf_r", "foot_r"},
        {"J_Bip_L_UpperLeg", "J_Bip_L_LowerLeg", "J_Bip_L_Foot", "J_Bip_R_UpperLeg", "J_Bip_R_LowerLeg",
         "J_Bip_R_Foot"},
        {"Bip01 L Thigh", "Bip01 L Calf", "Bip01 L Foot", "Bip01 R Thigh", "Bip01 R Calf", "Bip01 R Foot"},
        {"lThighBend", "lShin", "lFoot", "rThighBend", "rShin", "rFoot"},
        {"leg_joint_L_1", "leg_joint_L_2", "leg_joint_L_3", "leg_joint_R_1", "leg_joint_R_2", "leg_joint_R_3"},
        {"left_hip", "left_knee", "left_ankle", "right_hip", "right_knee", "right_ankle"}};
    for (auto const& names : skeletons) {
        AvatarJoints const j = find_avatar_joints(Walker(names).scene);
        EXPECT_EQ(j.left_leg.upper, 9) << names[0];
        EXPECT_EQ(j.left_leg.lower, 10) << names[1];
        EXPECT_EQ(j.left_leg.foot, 11) << names[2];
        EXPECT_EQ(j.right_leg.upper, 12) << names[3];
        EXPECT_EQ(j.right_leg.lower, 13) << names[4];
        EXPECT_EQ(j.right_leg.foot, 14) << names[5];
    }
    EXPECT_EQ(find_avatar_joints(Walker(kMixamoLegs, true).scene).right_leg.foot, 14) << "below a control";
}

TEST(AvatarJoints, WithoutLegsAnAvatarIsAnAvatar)
{
    EXPECT_EQ(find_avatar_joints(Figure(kMixamo).scene).left_leg.foot, -1);
    AvatarJoints const j =
        find_avatar_joints(Walker({"a", "b", "c", "RightUpLeg", "RightLeg", "RightFoot"}).scene);
    EXPECT_EQ(j.right_leg.foot, -1) << "both or none";
    AvatarNames names;
    names.left_leg = {"a", "b", "c"};
    Scene const scene = Walker({"a", "b", "c", "RightUpLeg", "RightLeg", "RightFoot"}).scene;
    EXPECT_EQ(find_avatar_joints(scene, names).left_leg.lower, 10);
    EXPECT_EQ(find_avatar_joints(scene, names).right_leg.lower, 13);
}

struct Driven {
    Scene scene;
    Avatar avatar;
    Pose rest, pose;

    explicit Driven(Scene s, AvatarNames const& names = {})
        : scene(std::move(s)),
          avatar(make_avatar(scene, find_avatar_joints(scene, names))),
          rest(evaluate_pose(scene, std::nullopt)),
          pose(rest)
    {
    }
    void to(AvatarTargets const& targets, std::optional<double> time_s = std::nullopt)
    {
        pose = evaluate_pose(scene, time_s);
        drive(scene, avatar, targets, pose);
    }
    double bone(Pose const& p, std::int32_t a, std::int32_t b) const
    {
        return glm::distance(place(p, a), place(p, b));
    }
};

/// Where its trackers are at rest, nothing moves.
TEST(AvatarDrive, TrackersAtRestLeaveItAtRest)
{
    Driven d{Figure(kMixamo).scene};
    dquat const looks = glm::angleAxis(glm::pi<double>(), dvec3{0, 1, 0}); // -Z to +Z
    d.to({rigid(place(d.rest, Figure::kHead), looks), {}, {}});
    for (std::size_t n = 0; n < d.scene.nodes.size(); ++n)
        for (int c = 0; c < 4; ++c)
            EXPECT_LT(glm::distance(d.pose.world_from_node[n][c], d.rest.world_from_node[n][c]), 1e-9) << n;
    d.to({});
    EXPECT_EQ(d.pose.world_from_node, d.rest.world_from_node);
}

TEST(AvatarDrive, LookingAsideTurnsTheBodyAndNoddingDoesNot)
{
    Driven d{Figure(kMixamo).scene};
    dquat const to_x = glm::angleAxis(-glm::half_pi<double>(), dvec3{0, 1, 0}); // -Z to +X
    for (double const nod : {0.0, 0.6, -1.5}) {
        d.to({rigid({5, 1.4, 5}, to_x * glm::angleAxis(nod, dvec3{1, 0, 0})), {}, {}});
        EXPECT_LT(glm::distance(place(d.pose, Figure::kHead), dvec3{5, 1.4, 5}), 1e-9);
        dvec3 const left = place(d.pose, 3) - place(d.pose, 6);
        EXPECT_LT(glm::distance(left, dvec3{0, 0, -0.4}), 1e-9) << "its left is -Z where it faces +X";
    }
}

TEST(AvatarDrive, HeadsTurnAsTheirTrackers)
{
    Driven d{Figure(kMixamo).scene};
    dquat const a = glm::normalize(dquat(0.9, 0.1, 0.3, -0.2)), b = glm::normalize(dquat(0.2, -0.5, 0.7, 0.1));
    d.to({rigid({0, 1, 0}, a), {}, {}});
    glm::dmat3 const head_a(d.pose.world_from_node[Figure::kHead]);
    d.to({rigid({0, 1, 0}, b), {}, {}});
    glm::dmat3 const head_b(d.pose.world_from_node[Figure::kHead]);
    glm::dmat3 const between = glm::mat3_cast(b * glm::inverse(a)) * head_a;
    for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(between[c], head_b[c]), 1e-9);
}

void expect_hands_follow(Driven& d, int count, double scale, std::vector<double> const& times)
{
    std::mt19937_64 engine(5);
    std::normal_distribution<double> normal;
    auto const random_point = [&] { return dvec3{normal(engine), normal(engine), normal(engine)}; };
    auto const random_turn = [&] {
        return glm::normalize(dquat(normal(engine), normal(engine), normal(engine), normal(engine)));
    };
    for (int i = 0; i < count; ++i) {
        std::optional<double> time;
        if (!times.empty()) time = times[std::size_t(i) % times.size()];
        Pose const before = evaluate_pose(d.scene, time);
        AvatarTargets t;
        if (i % 3 > 0) t.head = rigid(place(d.rest, d.avatar.head) + scale * random_point(), random_turn());
        d.to(t, time);
        for (Avatar::Arm const* arm : {&d.avatar.left, &d.avatar.right}) {
            ArmJoints const& j = arm->joints;
            double const upper = d.bone(before, j.upper, j.lower), lower = d.bone(before, j.lower, j.hand);
            dvec3 const shoulder = place(d.pose, j.upper);
            double const share = std::uniform_real_distribution<double>(0, 1)(engine);
            double const distance = std::abs(upper - lower) + share * (upper + lower - std::abs(upper - lower));
            dvec3 const target = shoulder + distance * glm::normalize(random_point());
            (arm->outward > 0 ? t.left_hand : t.right_hand) = rigid(target, random_turn());
        }
        d.to(t, time);
        for (Avatar::Arm const* arm : {&d.avatar.left, &d.avatar.right}) {
            ArmJoints const& j = arm->joints;
            double const upper = d.bone(before, j.upper, j.lower), lower = d.bone(before, j.lower, j.hand);
            dvec3 const target((arm->outward > 0 ? t.left_hand : t.right_hand)->operator[](3));
            EXPECT_LT(glm::distance(place(d.pose, j.hand), target), 1e-6 * (upper + lower)) << i;
            EXPECT_NEAR(d.bone(d.pose, j.upper, j.lower), upper, 1e-6 * upper) << i;
            EXPECT_NEAR(d.bone(d.pose, j.lower, j.hand), lower, 1e-6 * lower) << i;
        }
    }
}

TEST(AvatarDrive, HandsReachThousandsOfTargets)
{
    Driven d{Figure(kMixamo).scene};
    expect_hands_follow(d, 5000, 1, {});
}

TEST(AvatarDrive, HandsTurnAsTheirTrackers)
{
    Driven d{Figure(kMixamo).scene};
    // Fingers along +X, back of the hand up: as at rest but for the bend of the elbow.
    dquat const out = glm::quat_cast(glm::dmat3(dvec3{0, 0, 1}, dvec3{0, 1, 0}, dvec3{-1, 0, 0}));
    d.to({{}, rigid({0.6, 1.2, 0.2}, out), {}});
    dmat4 const spread = d.pose.world_from_node[Figure::kLeftHand];
    dquat const down = glm::angleAxis(-glm::half_pi<double>(), dvec3{0, 0, 1}) * out;
    d.to({{}, rigid({0.6, 1.2, 0.2}, down), {}});
    dmat4 const turned = glm::mat4_cast(down * glm::inverse(out)) * spread;
    for (int c = 0; c < 3; ++c)
        EXPECT_LT(glm::distance(turned[c], d.pose.world_from_node[Figure::kLeftHand][c]), 1e-9);
}

TEST(AvatarDrive, ElbowsHangDown)
{
    Driven d{Figure(kMixamo).scene};
    d.to({{}, rigid({0.2, 1.5, 0.4}, {1, 0, 0, 0}), rigid({-0.2, 1.5, 0.4}, {1, 0, 0, 0})});
    EXPECT_LT(place(d.pose, 4).y, 1.5 - 0.1);
    EXPECT_LT(place(d.pose, 7).y, 1.5 - 0.1);
    EXPECT_NEAR(place(d.pose, 4).x, -place(d.pose, 7).x, 1e-9) << "both sides alike";
}

TEST(AvatarDrive, LostOrImpossibleTrackersDoNoHarm)
{
    Driven d{Figure(kMixamo).scene};
    dmat4 lost(1);
    lost[3].x = std::nan("");
    d.to({lost, lost, lost});
    EXPECT_EQ(d.pose.world_from_node, d.rest.world_from_node);
    for (dmat4 const& strange :
         {dmat4(0.0), rigid({1e9, 0, 0}, {1, 0, 0, 0}), rigid(place(d.rest, 3), {1, 0, 0, 0})}) {
        d.to({strange, strange, strange});
        for (dmat4 const& m : d.pose.world_from_node)
            for (int c = 0; c < 4; ++c) EXPECT_TRUE(std::isfinite(glm::length(m[c])));
    }
}

/// A wave of the hand in steps of a few millimetres moves no joint by more than centimetres.
TEST(AvatarDrive, SmoothTrackersMoveSmoothly)
{
    Driven d{Figure(kMixamo).scene};
    Pose before;
    for (int i = 0; i <= 2000; ++i) {
        double const t = 6.28318530717958648 * i / 2000;
        dquat const turn = glm::angleAxis(glm::pi<double>() + 0.5 * std::sin(t), dvec3{0, 1, 0});
        d.to({rigid({0.1 * std::sin(t), 1.6, 0}, turn),
              rigid({0.25 + 0.2 * std::sin(2 * t), 1.4 + 0.2 * std::cos(t), 0.35}, turn),
              {}});
        if (i > 0) {
            for (std::size_t n = 0; n < d.scene.nodes.size(); ++n)
                for (int c = 0; c < 4; ++c)
                    EXPECT_LT(glm::distance(d.pose.world_from_node[n][c], before.world_from_node[n][c]), 0.02)
                        << i;
        }
        before = d.pose;
    }
}

dquat const kFacing = glm::angleAxis(glm::pi<double>(), dvec3{0, 1, 0}); // -Z to +Z, as at rest

double leg_length(Driven const& d, Avatar::Leg const& leg)
{
    return d.bone(d.pose, leg.joints.upper, leg.joints.lower) + d.bone(d.pose, leg.joints.lower, leg.joints.foot);
}

TEST(AvatarLegs, FeetAtRestLeaveThemAtRest)
{
    for (bool const has_controls : {false, true}) {
        Driven d{Walker(kMixamoLegs, has_controls).scene};
        ASSERT_TRUE(d.avatar.has_legs());
        AvatarTargets t;
        t.left_foot = rigid(place(d.rest, Walker::kLeftFoot), kFacing);
        t.right_foot = rigid(place(d.rest, Walker::kRightFoot), kFacing);
        d.to(t);
        for (std::size_t n = 0; n < d.scene.nodes.size(); ++n)
            for (int c = 0; c < 4; ++c)
                EXPECT_LT(glm::distance(d.pose.world_from_node[n][c], d.rest.world_from_node[n][c]), 1e-6) << n;
    }
}

/// Heads sink, feet stay, knees come forward, further the deeper.
TEST(AvatarLegs, WhoCrouchesKeepsHisFeetOnTheFloor)
{
    for (bool const has_controls : {false, true}) {
        Driven d{Walker(kMixamoLegs, has_controls).scene};
        double knee_before = 0;
        for (double const down : {0.02, 0.1, 0.3, 0.6}) {
            AvatarTargets t;
            t.head = rigid(place(d.rest, Figure::kHead) - dvec3{0, down, 0}, kFacing);
            t.left_foot = rigid(place(d.rest, Walker::kLeftFoot), kFacing);
            t.right_foot = rigid(place(d.rest, Walker::kRightFoot), kFacing);
            d.to(t);
            for (Avatar::Leg const* leg : {&d.avatar.left_leg, &d.avatar.right_leg}) {
                LegJoints const& j = leg->joints;
                EXPECT_LT(glm::distance(place(d.pose, j.foot), place(d.rest, j.foot)), 1e-9);
                EXPECT_NEAR(d.bone(d.pose, j.upper, j.lower), 0.5, 1e-9);
                EXPECT_NEAR(d.bone(d.pose, j.lower, j.foot), 0.45, 1e-9);
                EXPECT_GT(place(d.pose, j.lower).z, knee_before + 0.05) << down;
                EXPECT_NEAR(place(d.pose, j.lower).x, place(d.pose, j.upper).x, 1e-9) << "straight ahead";
            }
            knee_before = std::min(place(d.pose, 10).z, place(d.pose, 13).z);
        }
    }
}

TEST(AvatarLegs, HeelsRiseBeforeFeetLeaveTheFloor)
{
    Driven d{Walker(kMixamoLegs).scene};
    dvec3 const foot = place(d.rest, Walker::kLeftFoot);
    auto const raised = [&](double up) {
        AvatarTargets t;
        t.head = rigid(place(d.rest, Figure::kHead) + dvec3{0, up, 0}, kFacing);
        t.left_foot = rigid(foot, kFacing);
        d.to(t);
        return d.pose.world_from_node[Walker::kLeftFoot];
    };
    dmat4 const flat = raised(0), tiptoe = raised(0.05), jump = raised(0.6);
    // The ball of the foot in the foot's own frame stays where it is.
    glm::dvec4 const ball = glm::inverse(flat) * glm::dvec4(foot + dvec3{0, -0.05, 0.15 * 0.95}, 1);
    EXPECT_LT(glm::distance(tiptoe * ball, flat * ball), 1e-9);
    EXPECT_GT(tiptoe[3].y, flat[3].y + 0.04) << "the heel rises";
    EXPECT_GT((jump * ball).y, (flat * ball).y + 0.3) << "then he jumps";
    EXPECT_NEAR(leg_length(d, d.avatar.left_leg), 0.95, 1e-9) << "and no leg stretches";
    EXPECT_NEAR(d.bone(d.pose, 9, 11), 0.95, 1e-6) << "straight";
}

TEST(AvatarLegs, LostOrImpossibleFeetDoNoHarm)
{
    Driven d{Walker(kMixamoLegs).scene};
    dmat4 lost(1);
    lost[3].y = std::nan("");
    AvatarTargets t;
    t.left_foot = t.right_foot = lost;
    d.to(t);
    EXPECT_EQ(d.pose.world_from_node, d.rest.world_from_node);
    for (dvec3 const at : {dvec3{0.1, 1, 0}, dvec3{1e9, 0, 0}, dvec3{0.1, 3, 0}, dvec3{0.1, 1, 1e-13}}) {
        t.left_foot = t.right_foot = rigid(at, kFacing);
        d.to(t);
        for (dmat4 const& m : d.pose.world_from_node)
            for (int c = 0; c < 4; ++c) EXPECT_TRUE(std::isfinite(glm::length(m[c]))) << at.y << " " << at.z;
        EXPECT_NEAR(leg_length(d, d.avatar.left_leg), 0.95, 1e-6);
    }
}

/// Anywhere around the hips: what can be reached is, whatever else is finite, bones keep their lengths.
void expect_feet_follow(Driven& d, int count, double scale, std::optional<double> time)
{
    std::mt19937_64 engine(7);
    std::normal_distribution<double> normal;
    auto const random_point = [&] { return dvec3{normal(engine), normal(engine), normal(engine)}; };
    auto const random_turn = [&] {
        return glm::normalize(dquat(normal(engine), normal(engine), normal(engine), normal(engine)));
    };
    Pose const before = evaluate_pose(d.scene, time);
    int reached = 0;
    for (int i = 0; i < count; ++i) {
        AvatarTargets t;
        if (i % 3 > 0) t.head = rigid(place(d.rest, d.avatar.head) + scale * random_point(), random_turn());
        d.to(t, time);
        dvec3 const middle =
            0.5 * (place(d.pose, d.avatar.left_leg.joints.upper) + place(d.pose, d.avatar.right_leg.joints.upper));
        t.left_foot = rigid(middle + 0.6 * scale * random_point(), random_turn());
        t.right_foot = rigid(middle + 0.6 * scale * random_point(), random_turn());
        d.to(t, time);
        for (Avatar::Leg const* leg : {&d.avatar.left_leg, &d.avatar.right_leg}) {
            LegJoints const& j = leg->joints;
            double const upper = d.bone(before, j.upper, j.lower), lower = d.bone(before, j.lower, j.foot);
            dvec3 const goal((leg == &d.avatar.left_leg ? t.left_foot : t.right_foot)->operator[](3));
            double const far = glm::distance(goal, place(d.pose, j.upper));
            if (far < upper + lower && far > std::abs(upper - lower)) {
                EXPECT_LT(glm::distance(place(d.pose, j.foot), goal), 1e-3 * scale) << i;
                ++reached;
            }
            EXPECT_NEAR(d.bone(d.pose, j.upper, j.lower), upper, 1e-6 * upper) << i;
            EXPECT_NEAR(d.bone(d.pose, j.lower, j.foot), lower, 1e-6 * lower) << i;
        }
        for (dmat4 const& m : d.pose.world_from_node)
            for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(glm::length(m[c]))) << i;
    }
    EXPECT_GT(reached, count / 4);
}

TEST(AvatarLegs, FeetReachThousandsOfTargets)
{
    Driven d{Walker(kMixamoLegs).scene};
    expect_feet_follow(d, 10000, 1, {});
    Driven controls{Walker(kMixamoLegs, true).scene};
    expect_feet_follow(controls, 1000, 1, {});
}

void expect_real(std::string const& name, AvatarNames const& names)
{
    Report report;
    Scene scene = load_scene((shared_data() / "avatars" / name).string(), report);
    Driven d{std::move(scene), names};
    SCOPED_TRACE(describe(d.scene, find_avatar_joints(d.scene, names)));
    expect_hands_follow(d, 300, d.bone(d.rest, d.avatar.left.joints.upper, d.avatar.left.joints.hand),
                        {0.0, 0.4, 0.9});
    ASSERT_TRUE(d.avatar.has_legs());
    expect_feet_follow(d, 300, leg_length(d, d.avatar.left_leg), {});
}

TEST(AvatarJoints, AFoxHasNoLegsThatCanBeTold)
{
    LIGHTWELL_NEED_DATA("avatars/fox.glb");
    Report report;
    Scene const fox = load_scene((shared_data() / "avatars/fox.glb").string(), report);
    EXPECT_FALSE(make_avatar(fox, find_avatar_joints(fox)).has_legs());
}

TEST(AvatarDrive, QuaterniusHuman)
{
    LIGHTWELL_NEED_DATA("avatars/quaternius_human.glb");
    expect_real("quaternius_human.glb", {});
}

TEST(AvatarDrive, RobotExpressive)
{
    LIGHTWELL_NEED_DATA("avatars/robot_expressive.glb");
    expect_real("robot_expressive.glb", {});
}

TEST(AvatarDrive, CesiumManByExplicitNames)
{
    LIGHTWELL_NEED_DATA("avatars/cesium_man.glb");
    expect_real("cesium_man.glb", {"node 20",
                                   {"node 16", "node 17", "node 18"},
                                   {"node 13", "node 14", "node 15"},
                                   {"node 7", "node 8", "node 9"},
                                   {"node 3", "node 4", "node 5"}});
}

} // namespace
} // namespace gi::test
