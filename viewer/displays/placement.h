#pragma once
// A pose as display files write it, by translation and angles.

#include "gi/core/math.h"
#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Rotation in degrees about the room's x, then y, then z axis; then translation.
struct Placement {
    gi::dvec3 translation_m{0}, rotation_deg{0};

    bool operator==(Placement const&) const = default;
};
RoomPose pose_of(Placement const& placement);
/// The placement of a pose. The angle about y is within +-90 degrees.
Placement placement_of(RoomPose const& pose);

} // namespace viewer
