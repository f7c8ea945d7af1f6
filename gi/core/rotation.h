#pragma once
// Rotations as vectors: axis times angle; headings.

#include "gi/core/math.h"

namespace gi {

/// Rotation vector (rad) of a unit quaternion; the shorter way, so at most pi long.
dvec3 log_rotation(dquat rotation);
/// The unit quaternion of a rotation vector (rad).
dquat exp_rotation(dvec3 vector_rad);
/// Horizontal direction that a body (forward -Z, top +Y, in a room with +Y up) faces, also if it looks straight up
/// or down; not normalised.
dvec3 heading(dquat const& body);
/// The rotation about +Y from -Z to the heading.
dquat heading_of(dquat const& body);

} // namespace gi
