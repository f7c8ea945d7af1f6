#pragma once
// Eyes and the cameras that look from them through the walls.

#include "viewer/displays/display.h"
#include "viewer/protocol/frame_command.h"

#include <optional>
#include <span>
#include <vector>

namespace viewer {

enum class Eye { middle, left, right };
char const* name_of(Eye eye);

/// Room positions, m.
struct Eyes {
    gi::dvec3 left{0}, right{0}, middle{0};
};
/// The head looks along -Z of its pose, +X to its right.
Eyes eyes_of(User const& user, RoomPose const& head);
/// Where the head is while nothing tracks it.
RoomPose resting_head(User const& user);

/// One eye before one wall.
struct DisplayView {
    int wall = 0;
    Eye eye = Eye::middle;
    std::string name;                ///< "left wall, right eye"
    int width_px = 0, height_px = 0; ///< to render
    EyePlace place = EyePlace::before;
    std::optional<gi::Camera> camera; ///< in the room; nothing where the wall stays dark for this eye
    int partner = -1;                 ///< index of the other eye's view of this wall, if that came earlier
};

/// Two views for a wall in stereo (the eye in the left eye's place first: the left one, or with swap_eyes the
/// right one), one from the middle for a wall without. `heads` by user; those that are missing or empty rest.
/// Walls in their order; those of other ranks are left out (-1 = all ranks).
std::vector<DisplayView> views_of(Display const& display, std::span<std::optional<RoomPose> const> heads,
                                  int rank = -1);

/// Those that see their wall, in the world. world_from_room is rigid up to a scale. The views' indices are given
/// by `sources` where it is not null.
std::vector<ViewCommand> view_orders(std::span<DisplayView const> views, gi::dmat4 const& world_from_room,
                                     std::vector<int>* sources = nullptr);

} // namespace viewer
