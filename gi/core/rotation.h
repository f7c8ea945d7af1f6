#pragma once
// Rotations as vectors: axis times angle.

#include "gi/core/math.h"

namespace gi {

/// Rotation vector (rad) of a unit quaternion; the shorter way, so at most pi long.
dvec3 log_rotation(dquat rotation);
/// The unit quaternion of a rotation vector (rad).
dquat exp_rotation(dvec3 vector_rad);

} // namespace gi
