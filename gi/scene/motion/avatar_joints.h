#pragma once
// Identification of a skeleton's head, arms, hands, legs and feet.

#include "gi/scene/model/scene.h"

namespace gi {

/// Node indices of the shoulder joint (which moves the upper arm), the elbow and the wrist.
struct ArmJoints {
    std::int32_t upper = -1, lower = -1, hand = -1;
};

/// Node indices of the hip joint (which moves the thigh), the knee and the ankle; all -1 if no legs are found.
struct LegJoints {
    std::int32_t upper = -1, lower = -1, foot = -1;
};

struct AvatarJoints {
    std::int32_t head = -1;
    ArmJoints left, right;         ///< the avatar's own left and right
    LegJoints left_leg, right_leg; ///< both or none
};

/// Node names, for skeletons with unknown naming; empty names are searched for automatically.
struct ArmNames {
    std::string upper, lower, hand;
};

struct LegNames {
    std::string upper, lower, foot;
};

struct AvatarNames {
    std::string head;
    ArmNames left, right;
    LegNames left_leg{}, right_leg{};
};

/// Side in a joint's name: +1 left, -1 right, 0 none.
int joint_side(std::string const& name);

/// Finds joints by the names of common skeletons: Mixamo ("mixamorig:LeftForeArm"), Quaternius and Blender
/// ("LowerArm.L", "forearm.L"), Unreal ("lowerarm_l"), VRM, 3ds Max bipeds ("Bip01 L Forearm"), the glTF sample
/// models. An elbow or wrist (knee or ankle) without such a name is taken to be the only joint below the previous
/// one. Feet need not be descendants of their legs, as in rigs with controls. If a scene has several skeletons,
/// the given skin is used, or the first one with head and arms. Throws InputError with the missing and the
/// existing joints; legs may be missing.
AvatarJoints find_avatar_joints(Scene const& scene, AvatarNames const& names = {}, std::int32_t skin = -1);

} // namespace gi
