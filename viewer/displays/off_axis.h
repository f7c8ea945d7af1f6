#pragma once
// View of an eye through a wall: the generalised perspective projection of Kooima (2008). The camera is at the
// eye, its axes are parallel to the wall, and its view tangents are those of the wall's edges. So a point is drawn
// where the line from the eye to the point intersects the wall.
//
// Frames: room, right-handed, +Y up, metres, in doubles throughout.

#include "gi/core/error.h"
#include "gi/scene/model/camera.h"

#include <optional>

namespace viewer {

/// A flat rectangle that shows a picture; corners as seen by the viewer. The fourth corner follows.
struct WallCorners {
    gi::dvec3 lower_left{0}, lower_right{0}, upper_left{0}; ///< m, in the room

    bool operator==(WallCorners const&) const = default;
};

/// Shorter edges have no reliable direction; farther coordinates have too little precision.
inline constexpr double kShortestEdge_m = 1e-6, kFarthestCorner_m = 1e7;
/// Largest deviation of the lower left corner's angle from 90 degrees:
/// the error of a tape measure on a wall of 3 m.
inline constexpr double kSkew_deg = 0.25;
/// An eye nearer to the plane than this share of the longer edge gets no picture, because tangents beyond 1/this
/// are too large for rays in floats.
inline constexpr double kNearestEye = 1e-4;

/// Axes and size of a wall. up is exactly perpendicular to right, even if the corners
/// were skewed (up to kSkew_deg).
struct WallFrame {
    gi::dvec3 lower_left{0}, right{1, 0, 0}, up{0, 1, 0},
        normal{0, 0, 1}; ///< unit; normal points to the viewer's side
    double width_m = 0, height_m = 0;
    double skew_deg = 0; ///< deviation of the corners from a right angle

    /// u from the left edge, v from the lower one, both 0 to 1 on the wall.
    gi::dvec3 point(double u, double v) const { return lower_left + u * width_m * right + v * height_m * up; }
};

/// Error message for corners that form no valid rectangle: not finite or beyond kFarthestCorner_m, without area,
/// or skewed by more than kSkew_deg.
struct CornerFault {
    std::string problem, why, suggestion;
};
std::optional<CornerFault> find_fault(WallCorners const& corners);
/// Throws InputError if find_fault finds a fault.
WallFrame wall_frame(WallCorners const& corners);

/// Position of an eye relative to a wall.
enum class EyePlace {
    before,   ///< in front: it sees the wall
    too_near, ///< nearer to the plane than kNearestEye of the longer edge
    behind,   ///< it sees the back, which shows nothing
    unknown,  ///< its position is not finite
};
char const* name_of(EyePlace place);

EyePlace place_of(gi::dvec3 eye_m, WallFrame const& wall);
/// The camera in the room. None unless place_of is EyePlace::before; the wall then stays dark for this eye.
std::optional<gi::Camera> off_axis_camera(gi::dvec3 eye_m, WallFrame const& wall);

} // namespace viewer
