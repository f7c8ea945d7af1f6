#pragma once
// Avatars as puppets of tracked people: from tracked head and hands to what gi::drive wants.

#include "gi/scene/motion/avatar.h"
#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Of a person and an avatar. Frames of bodies: -Z forward (of hands: along the fingers), +Y up (back of the
/// hand).
struct PuppetMeasures {
    gi::dvec3 head_joint_in_head{0, -0.08,
                                 0.09}; ///< m, from the middle between the eyes; on the scale of the user
    RoomPose left_wrist_in_hand{{0, 0, 0.06}, {1, 0, 0, 0}}; ///< from the grip of the controller
    RoomPose right_wrist_in_hand{{0, 0, 0.06}, {1, 0, 0, 0}};
    gi::dvec3 left_ankle_in_foot{0, 0.08, 0}, right_ankle_in_foot{0, 0.08, 0}; ///< m, from the sole
    double avatar_per_user = 1; ///< height of the avatar by that of its user; the room's floor is y = 0

    bool operator==(PuppetMeasures const&) const = default;
};

/// How large the avatar is against its user, so that its feet are on the floor when the user stands.
/// @param user_eye_height_m above the floor, standing; throws InputError outside 0.3 to 3 m, or where the avatar's
///   head is not above its lowest point
double height_scale(gi::Scene const& scene, gi::Avatar const& avatar, double user_eye_height_m,
                    PuppetMeasures const& measures = {});

/// Targets in the world. Heights are scaled by avatar_per_user and hands and feet approach the head accordingly;
/// the head does not leave the vertical on which it is. A scale of world_from_room scales places and leaves the
/// targets rigid.
gi::AvatarTargets puppet_targets(Tracked const& tracked, gi::dmat4 const& world_from_room,
                                 PuppetMeasures const& measures = {});

} // namespace viewer
