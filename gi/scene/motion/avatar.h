#pragma once
// Tracker-driven avatar: targets for the head, two hands and two feet overwrite the pose from clips or rest.

#include "gi/scene/motion/animation.h"
#include "gi/scene/motion/avatar_joints.h"

namespace gi {

/// Properties of an avatar at rest that drive() needs, computed once. Frame "body": x = the avatar's left, y = up,
/// z = the direction it faces.
struct Avatar {
    struct Arm {
        ArmJoints joints;
        std::vector<std::int32_t> wrist;   ///< the hand and all joints at the same position
        dquat joint_from_hand{1, 0, 0, 0}; ///< a joint's orientation = the tracker's * this
        double outward = 1;                ///< +1 left, -1 right
    };
    struct Leg {
        LegJoints joints; ///< all -1 = none
        dquat joint_from_foot{1, 0, 0, 0};
        dvec3 ball_in_foot{0}; ///< ankle to ball of the foot, in the foot's frame and in leg lengths
    };
    bool has_legs() const { return left_leg.joints.foot >= 0 && right_leg.joints.foot >= 0; }

    std::vector<std::int32_t> tops; ///< root joints of the skeleton
    std::int32_t head = -1;
    dquat joint_from_head{1, 0, 0, 0};
    dquat world_from_body{1, 0, 0, 0};
    Arm left, right;
    Leg left_leg, right_leg; ///< both or none
    double floor_y = 0;      ///< height of the floor on which it stands at rest
};

/// Rigid transforms to the world (+Y up, m); absent or non-finite ones are not tracked.
struct AvatarTargets {
    std::optional<dmat4> head;                  ///< at the head joint; -Z = view direction, +Y = top of the head
    std::optional<dmat4> left_hand, right_hand; ///< at the wrist; -Z = along the fingers, +Y = back of the hand
    std::optional<dmat4> left_foot{}, right_foot{}; ///< at the ankle; -Z = along the toes, +Y = up
};

/// Analyses the scene at rest, where the avatar stands upright. Throws InputError if both
/// shoulders are at the same position.
Avatar make_avatar(Scene const& scene, AvatarJoints const& joints);

/// Overwrites the pose of the avatar's joints and all nodes below them. With a tracked head, the whole avatar
/// turns about the vertical to face in the head's direction and moves so that the head joint is at its target;
/// untracked feet may leave the floor. Arms are bent to the hand targets by reach(): elbows point down and
/// outwards for hands in front of the body, and this direction turns along for hands elsewhere; each bone takes
/// the shortest rotation. A hand whose target is out of reach still takes the target's orientation. Legs are bent
/// to the foot targets likewise (drive_leg). Bones keep their lengths.
void drive(Scene const& scene, Avatar const& avatar, AvatarTargets const& targets, Pose& pose);

} // namespace gi
