#pragma once
// What an eye sees through a wall: the generalised perspective projection of Kooima (2008). The camera stands in
// the eye, its axes lie along the wall, and the tangents of its view are those of the wall's edges; so a point
// drawn where the camera sees it lies on the line from the eye to the point.
//
// Frames: room, right-handed, +Y up, metres, in doubles throughout.

#include "gi/core/error.h"
#include "gi/scene/model/camera.h"

#include <optional>

namespace viewer {

/// A flat rectangle that shows a picture, as seen by who looks at it. The fourth corner follows.
struct WallCorners {
    gi::dvec3 lower_left{0}, lower_right{0}, upper_left{0}; ///< m, in the room

    bool operator==(WallCorners const&) const = default;
};

/// Edges shorter than this have no direction worth the name; coordinates beyond the other one no precision.
inline constexpr double kShortestEdge_m = 1e-6, kFarthestCorner_m = 1e7;
/// How far the angle at the lower left corner may be from a right one: what tape measures do to a wall of 3 m.
inline constexpr double kSkew_deg = 0.25;
/// An eye nearer to the plane than this share of the longer edge sees nothing: tangents beyond 1/this are too much
/// for rays in floats.
inline constexpr double kNearestEye = 1e-4;

/// Axes and size of a wall. up is at a right angle to right, also where the corners were off by up to kSkew_deg.
struct WallFrame {
    gi::dvec3 lower_left{0}, right{1, 0, 0}, up{0, 1, 0},
        normal{0, 0, 1}; ///< unit; normal is on the viewer's side
    double width_m = 0, height_m = 0;
    double skew_deg = 0; ///< how far the corners were from a right angle

    /// u from the left edge, v from the lower one, both 0 to 1 on the wall.
    gi::dvec3 point(double u, double v) const { return lower_left + u * width_m * right + v * height_m * up; }
};

/// Problem, why and suggestion where the corners are no rectangle: not finite or beyond kFarthestCorner_m, without
/// area, or skewed by more than kSkew_deg.
struct CornerFault {
    std::string problem, why, suggestion;
};
std::optional<CornerFault> find_fault(WallCorners const& corners);
/// Throws InputError where find_fault finds one.
WallFrame wall_frame(WallCorners const& corners);

/// Where an eye is, seen from a wall.
enum class EyePlace {
    before,   ///< it sees the wall
    too_near, ///< nearer to the plane than kNearestEye of the longer edge
    behind,   ///< it sees the back, which shows nothing
    unknown,  ///< its position is not finite
};
char const* name_of(EyePlace place);

EyePlace place_of(gi::dvec3 eye_m, WallFrame const& wall);
/// The camera in the room; nothing unless place_of is EyePlace::before: then the wall stays dark for this eye.
std::optional<gi::Camera> off_axis_camera(gi::dvec3 eye_m, WallFrame const& wall);

} // namespace viewer
