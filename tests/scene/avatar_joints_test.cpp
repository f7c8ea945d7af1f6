// Joints of avatars, found by their names.

#include "gi/core/error.h"
#include "gi/scene/load/load.h"
#include "tests/scene/avatar_figure.h"
#include "tests/support/data.h"

namespace gi::test {
namespace {

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
    AvatarJoints const found = find_avatar_joints(f.scene);
    EXPECT_EQ(f.scene.nodes[std::size_t(found.left.upper)].name, "mixamorig:LeftArm");
    EXPECT_EQ(f.scene.nodes[std::size_t(found.left.lower)].name, "mixamorig:LeftForeArm");
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
    for (char const* part : {"no head, left upper arm", "right hand", "existing joints: a, b, c"})
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
    names.left_leg = {"b", "a", "c"};
    EXPECT_THROW(find_avatar_joints(scene, names), InputError) << "what is named is not dropped";
}

TEST(AvatarJoints, AFoxHasNoLegsThatCanBeTold)
{
    LIGHTWELL_NEED_DATA("avatars/fox.glb");
    Report report;
    Scene const fox = load_scene((shared_data() / "avatars/fox.glb").string(), report);
    EXPECT_FALSE(make_avatar(fox, find_avatar_joints(fox)).has_legs());
}

} // namespace
} // namespace gi::test
