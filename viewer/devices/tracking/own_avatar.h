#pragma once
// The avatar of a tracked user in the scene: a skinned model, scaled to the user's height, that follows the
// position and gaze of the user's head, and the hands.
//
// The user's eyes are kept just in front of the avatar's face: the head joint is placed so far behind the midpoint
// between the eyes that no part of the head reaches the plane of the eyes. So the avatar never blocks its user's
// view, but is complete in mirrors, shadows and on other users' walls.

#include "gi/scene/motion/avatar.h"
#include "viewer/devices/tracking/footsteps.h"
#include "viewer/devices/tracking/puppet.h"

#include <memory>

namespace viewer {

/// Distance by which an avatar's head extends in front of its head joint, m in the scene at rest. Includes
/// vertices whose skin weights for the head's joint and its descendants sum to a quarter or more, and rigid meshes
/// attached to them. At least 0.
double reach_before_head_m(gi::Scene const& scene, gi::Avatar const& avatar);

class OwnAvatar {
public:
    /// @param avatar  upright at rest, +Y up, feet at y = 0; any length unit.
    /// Its lights, cameras and sky are ignored;
    ///   its clips do not play, but it takes the pose at the start of a clip with "idle" in its name
    /// @param eye_height_m  of the standing user, 0.3 to 3
    /// @param user  index in the display
    /// @param joints  of a joint map (gi/scene/motion/avatar_map.h); none = found by their names (avatar_joints.h)
    /// Throws InputError if its head or arms cannot be identified.
    OwnAvatar(gi::Scene avatar, double eye_height_m, std::size_t user = 0,
              std::optional<gi::AvatarJoints> const& joints = {});

    /// Returns the scene with the avatar added.
    gi::Scene joined(gi::Scene scene) const;
    /// Poses the avatar as its user in the frame command. Without tracking, the head is at the room's centre,
    /// hands hang down, and feet keep their places below the head. Scenes without the avatar are unchanged.
    void drive(gi::Scene const& scene, FrameCommand const& command, gi::Pose& pose) const;

    PuppetMeasures const& measures() const { return measures_; }
    /// Positions of its feet when standing; none for an avatar without legs.
    std::optional<Stance> const& stance() const { return stance_; }
    /// Its joints, as nodes of a scene that contains it. Throws InputError if the scene does not.
    gi::AvatarJoints joints_in(gi::Scene const& scene) const;

private:
    void measure_legs();

    gi::Scene scene_;
    gi::AvatarJoints joints_; ///< of scene_
    gi::Avatar avatar_;
    double eye_height_m_, scale_ = 1;
    std::size_t user_;
    std::string root_; ///< name of its root node
    PuppetMeasures measures_;
    std::optional<Stance> stance_;
};

} // namespace viewer
