#pragma once
// Transforms poses from a tracker's frame and units into the room: right-handed, m, +Y up, heads look along -Z.

#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Axes of a tracker, as right, up and forward for a person facing its front.
enum class TrackerAxes {
    y_up,             ///< right-handed: +x right, +y up, -z forward (OpenXR); no change
    z_up,             ///< right-handed: +x right, +z up, +y forward (usual for ART and OptiTrack rooms)
    left_handed_y_up, ///< +x right, +y up, +z forward (Unity, VMC)
    left_handed_z_up, ///< +y right, +z up, +x forward (Unreal)
};

/// Applied once to each sample, in this order: axes and units, then the rigid transform,
/// then the body's own frame.
struct TrackerToRoom {
    TrackerAxes axes = TrackerAxes::y_up;
    double metres_per_unit = 1; ///< of the samples as parsed; DTrack's are m already
    RoomPose room_from_tracker; ///< m; the tracker's origin and axes (after the change of axes) in the room

    bool operator==(TrackerToRoom const&) const = default;
};

/// @param sensor_from_body pose of the body (midpoint between the eyes, grip) relative to its marker
RoomPose to_room(TrackerToRoom const& transform, RoomPose const& in_tracker,
                 RoomPose const& sensor_from_body = {});

} // namespace viewer
