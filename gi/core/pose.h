#pragma once
// Rigid poses (position and rotation): composition, inverse, interpolation.

#include "gi/core/rotation.h"

namespace gi {

/// Pose of a rigid body, right-handed: maps points from the body's frame to that of its surroundings. Of people,
/// the surroundings are the room with +Y up; heads, hands and feet face along -Z.
struct RigidPose {
    dvec3 position{0};          ///< m
    dquat rotation{1, 0, 0, 0}; ///< unit, surroundings from body

    bool operator==(RigidPose const&) const = default;
};

/// Composition: a from c.
RigidPose operator*(RigidPose const& a_from_b, RigidPose const& b_from_c);
dvec3 operator*(RigidPose const& a_from_b, dvec3 const& point_b);
RigidPose inverse(RigidPose const& a_from_b);
/// Interpolates position and rotation from a (t = 0) to b (t = 1).
RigidPose between(RigidPose const& a, RigidPose const& b, double t);
bool is_finite(RigidPose const& pose);

} // namespace gi
