#pragma once
// An avatar driven from outside: trackers of a head, two hands and two feet overwrite the pose that clips or rest
// gave it.

#include "gi/scene/motion/animation.h"
#include "gi/scene/motion/avatar_joints.h"

namespace gi {

/// What the drive needs to know of an avatar at rest, found once. "Body" is x = the avatar's left, y = up, z = the
/// way it faces.
struct Avatar {
    struct Arm {
        ArmJoints joints;
        std::vector<std::int32_t> wrist;   ///< the hand and the joints that begin at the same place
        dquat joint_from_hand{1, 0, 0, 0}; ///< a joint's orientation = the tracker's * this
        double outward = 1;                ///< +1 left, -1 right
    };
    struct Leg {
        LegJoints joints; ///< all -1 = none
        dquat joint_from_foot{1, 0, 0, 0};
        dvec3 ball_in_foot{0}; ///< from the ankle, in the foot's frame and in lengths of the leg: what it rises on
    };
    bool has_legs() const { return left_leg.joints.foot >= 0 && right_leg.joints.foot >= 0; }

    std::vector<std::int32_t> tops; ///< joints of the skeleton that are below none of its others
    std::int32_t head = -1;
    dquat joint_from_head{1, 0, 0, 0};
    dquat world_from_body{1, 0, 0, 0};
    Arm left, right;
    Leg left_leg, right_leg; ///< both or none
    double floor_y = 0;      ///< of the scene at rest: what it stands on
};

/// Rigid transforms into the world (+Y up, m); those that are absent or not finite are not tracked.
struct AvatarTargets {
    std::optional<dmat4> head;                  ///< at the head joint; -Z = where it looks, +Y = its top
    std::optional<dmat4> left_hand, right_hand; ///< at the wrist; -Z = along the fingers, +Y = back of the hand
    std::optional<dmat4> left_foot{}, right_foot{}; ///< at the ankle; -Z = along the toes, +Y = up
};

/// Looks at the scene at rest, where the avatar stands upright. Throws InputError where both shoulders are at one
/// place.
Avatar make_avatar(Scene const& scene, AvatarJoints const& joints);

/// Overwrites the pose of the avatar's joints and all that hangs on them. With a head, the whole avatar turns
/// about the vertical to face as the head does and moves so that the head joint is at its target; feet that are
/// not tracked may leave the floor. Arms go to hands by reach(): elbows down and outwards where hands are in
/// front, and accordingly elsewhere; each bone by its shortest turn. A hand out of reach keeps its orientation.
/// Legs go to feet likewise (avatar_legs.h). Bones keep their lengths.
void drive(Scene const& scene, Avatar const& avatar, AvatarTargets const& targets, Pose& pose);

} // namespace gi
