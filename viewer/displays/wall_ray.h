#pragma once
// Where a wand points: the wall that a ray meets, and a menu's place around that point.

#include "viewer/displays/display.h"

#include <optional>

namespace viewer {

struct WallHit {
    int wall = 0;
    double u = 0, v = 0; ///< on the wall, from the lower left corner, 0 to 1
    double distance_m = 0;
};

/// The nearest wall whose front is met by the ray from a wand's position along its -Z.
/// @param rank  whose walls count; -1 = all
std::optional<WallHit> hit_wall(Display const& display, RoomPose const& wand, int rank = -1);
/// Where the ray meets this wall's plane from the front, also beside the wall: u and v may be outside 0 to 1.
std::optional<WallHit> hit_plane(Display const& display, int wall, RoomPose const& wand);

/// A rectangle of a wall, in shares of its width and height from the lower left corner.
struct WallRectangle {
    double left = 0, bottom = 0, width = 1, height = 1;

    bool operator==(WallRectangle const&) const = default;

    /// The point in shares of the rectangle, x from its left, y from its top; outside 0 to 1 beside it.
    glm::dvec2 inside(WallHit const& hit) const { return {(hit.u - left) / width, 1 - (hit.v - bottom) / height}; }
};

/// A rectangle of at most 0.75 m x 0.95 m and 80 % of the wall's edges, centred at
/// the point as far as the wall allows.
WallRectangle menu_place(WallFrame const& wall, double u, double v);

} // namespace viewer
