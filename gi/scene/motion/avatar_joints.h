#pragma once
// Which joints of a skeleton are head, arms, hands, legs and feet.

#include "gi/scene/model/scene.h"

namespace gi {

/// Node indices: the joint at the shoulder that moves the upper arm, elbow, wrist.
struct ArmJoints {
    std::int32_t upper = -1, lower = -1, hand = -1;
};

/// The joint at the hip that moves the thigh, knee, ankle; all -1 where no legs can be told.
struct LegJoints {
    std::int32_t upper = -1, lower = -1, foot = -1;
};

struct AvatarJoints {
    std::int32_t head = -1;
    ArmJoints left, right;         ///< the avatar's own left and right
    LegJoints left_leg, right_leg; ///< both or none
};

/// Names of nodes, for skeletons whose names tell nothing; those that are empty are looked for.
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

/// Joints by their names in common skeletons: Mixamo ("mixamorig:LeftForeArm"), Quaternius and Blender
/// ("LowerArm.L", "forearm.L"), Unreal ("lowerarm_l"), VRM, 3ds Max bipeds ("Bip01 L Forearm"), the glTF sample
/// models. Where an elbow or wrist (knee or ankle) has no such name, it is the only joint below the one before it.
/// Feet may hang elsewhere than on their legs, as in rigs with controls. Of several
/// skeletons in a scene the first that has head and arms counts, or the given skin. Throws InputError that says
/// what of these was not found and which joints there are; legs may be missing.
AvatarJoints find_avatar_joints(Scene const& scene, AvatarNames const& names = {}, std::int32_t skin = -1);

} // namespace gi
