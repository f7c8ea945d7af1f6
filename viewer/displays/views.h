#pragma once
// Eyes, and their cameras through the walls.

#include "viewer/displays/cube_faces.h"
#include "viewer/displays/display.h"
#include "viewer/protocol/frame_command.h"

#include <optional>
#include <span>
#include <vector>

namespace viewer {

/// Room positions, m.
struct Eyes {
    gi::dvec3 left{0}, right{0}, middle{0};
};
/// The head looks along -Z of its pose, +X to its right.
Eyes eyes_of(User const& user, RoomPose const& head);
/// Head pose without tracking.
RoomPose resting_head(User const& user);

/// View of one eye on one wall, or on one face of the cube for a wall that is not flat.
struct DisplayView {
    int wall = 0;
    Eye eye = Eye::middle;
    std::optional<CubeFace> face;    ///< of a wall that is not flat
    std::string name;                ///< "left wall, right eye" or "dome, right eye, front face"
    int width_px = 0, height_px = 0; ///< to render
    EyePlace place = EyePlace::before;
    std::optional<gi::Camera> camera; ///< in the room; none if the wall stays dark for this eye
    int partner = -1;                 ///< index of the other eye's view of this wall, if it is earlier
};

/// The faces of a wall with a surface, of a constant number and size: seen from around the user's resting head.
std::vector<FaceView> faces_of(Display const& display, Wall const& wall);

/// Two views per stereo wall (first the eye shown in the left eye's place: left, or right with swap_eyes), one
/// from the midpoint between the eyes per mono wall, one of its eye per wall for one eye; for a wall that is not
/// flat as many of each as it needs faces. Walls of the same place for the left and the right eye are partners.
/// `heads` is indexed by user; missing or empty heads are at
/// rest. Walls are in order; walls of other ranks are skipped (-1 = all ranks).
std::vector<DisplayView> views_of(Display const& display, std::span<std::optional<RoomPose> const> heads,
                                  int rank = -1);

/// View commands, in the world, for the views that see their wall. world_from_room is rigid up to a scale.
/// If `sources` is not null, it receives the views' indices.
std::vector<ViewCommand> view_orders(std::span<DisplayView const> views, gi::dmat4 const& world_from_room,
                                     std::vector<int>* sources = nullptr);

} // namespace viewer
