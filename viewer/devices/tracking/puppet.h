#pragma once
// Avatars as puppets of tracked people: converts tracked bodies to the targets of gi::drive.

#include "gi/scene/motion/avatar.h"
#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Measures of a person and an avatar. Frames of bodies: -Z forward (hands:
/// along the fingers), +Y up (hands: back of the hand).
struct PuppetMeasures {
    gi::dvec3 head_joint_in_head{0, -0.08, 0.09}; ///< m, from the midpoint between the eyes; at the user's scale
    RoomPose left_wrist_in_hand{{0, 0, 0.06}, {1, 0, 0, 0}}; ///< from the controller's grip
    RoomPose right_wrist_in_hand{{0, 0, 0.06}, {1, 0, 0, 0}};
    gi::dvec3 left_ankle_in_foot{0, 0.08, 0}, right_ankle_in_foot{0, 0.08, 0}; ///< m, from the sole
    double avatar_per_user = 1; ///< avatar height over user height; the room's floor is y = 0

    bool operator==(PuppetMeasures const&) const = default;
};

/// Height of the avatar over that of its user, such that its feet are on the floor when the user stands.
/// @param user_eye_height_m above the floor, standing; throws InputError outside 0.3 to 3 m, or if the avatar's
///   head is not above its lowest point
double height_scale(gi::Scene const& scene, gi::Avatar const& avatar, double user_eye_height_m,
                    PuppetMeasures const& measures = {});

/// Targets in the world. Heights are scaled by avatar_per_user, and offsets of hands and feet from
/// the head likewise; the head stays on its vertical line. A scale in world_from_room scales positions;
/// the targets stay rigid.
gi::AvatarTargets puppet_targets(Tracked const& tracked, gi::dmat4 const& world_from_room,
                                 PuppetMeasures const& measures = {});

} // namespace viewer
