#pragma once
// The avatar of a tracked user in the scene that he walks through: a skinned model, scaled to his height, that
// stands where he stands, looks where he looks and has its hands where his are.
//
// His eyes are kept just before its face: the head joint lies so far behind the middle between the eyes that
// nothing of the head reaches the plane of the eyes. So it never covers what its user sees, while mirrors, shadows
// and other users' walls have all of it.

#include "gi/scene/motion/avatar.h"
#include "viewer/devices/tracking/footsteps.h"
#include "viewer/devices/tracking/puppet.h"

#include <memory>

namespace viewer {

/// How far an avatar's head reaches before its head joint, m in the scene at rest: vertices that the head's joint
/// or a joint below it moves by a quarter or more, and rigid meshes that hang on them. At least 0.
double reach_before_head_m(gi::Scene const& scene, gi::Avatar const& avatar);

class OwnAvatar {
public:
    /// @param avatar  upright at rest, +Y up, feet at y = 0; any length unit. Its lights, cameras and sky are left
    /// out;
    ///   its clips do not play, but it stands as at the start of one that has "idle" in its name
    /// @param eye_height_m  of its standing user, 0.3 to 3
    /// @param user  whose it is: 0 = the first of the display
    /// Throws InputError where it has no head or arms that can be told by their names (avatar_joints.h).
    OwnAvatar(gi::Scene avatar, double eye_height_m, std::size_t user = 0);

    /// The scene with the avatar in it.
    gi::Scene joined(gi::Scene scene) const;
    /// Puts the avatar where the order has its user. A head that is not tracked stands in the middle of the room;
    /// hands that are not hang down; feet that are not keep their places below the head. Scenes without the avatar
    /// are left as they are.
    void drive(gi::Scene const& scene, FrameCommand const& order, gi::Pose& pose) const;

    PuppetMeasures const& measures() const { return measures_; }
    /// Where its feet are while it stands; none of an avatar without legs.
    std::optional<Stance> const& stance() const { return stance_; }
    /// Its joints, as nodes of a scene that has it. Throws InputError where it is not there.
    gi::AvatarJoints joints_in(gi::Scene const& scene) const;

private:
    void measure_legs();

    gi::Scene scene_;
    gi::AvatarJoints joints_; ///< of scene_
    gi::Avatar avatar_;
    double eye_height_m_, scale_ = 1;
    std::size_t user_;
    std::string root_; ///< name of the node that it hangs on
    PuppetMeasures measures_;
    std::optional<Stance> stance_;
};

} // namespace viewer
