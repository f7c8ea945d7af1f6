#pragma once
// Surfaces that are not flat: domes, cylinders, and domes lit through a spherical mirror. Each point of a wall's
// viewport lights one point of the surface, wherever the eyes are; what an eye sees there is what lies in the
// direction from the eye to that point.
//
// Frame of a surface: its own, placed in the room by `place`; right-handed, +Y up, looks along -Z. Viewport
// positions (u, v) count from the lower left corner, 0 to 1. Azimuths are 0 at -Z and positive to the right,
// elevations positive upward.
//
// fisheye (equidistant): the circle in the viewport shows the directions within fov / 2 of -Z; a point at the
//   share r of the circle's radius is r * fov / 2 from -Z, above the centre where it is above it in the viewport.
// cylindrical: u goes over the azimuths, v over the heights on a cylinder about the frame's y axis.
// equirectangular: u goes over the azimuths, v over the elevations of a sphere.
// spherical_mirror: a projector lights a mirrored ball, which lights a sphere from within (P. Bourke, "Using a
//   spherical mirror for projection into immersive environments", 2005). A ray that misses the ball is dark.
// points: a calibration says which point of the frame each pixel lights.

#include "viewer/displays/pixel_map.h"
#include "viewer/displays/placement.h"

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

namespace viewer {

enum class SurfaceType { fisheye, cylindrical, equirectangular, spherical_mirror, points };
inline constexpr std::array kSurfaceTypes{SurfaceType::fisheye, SurfaceType::cylindrical,
                                          SurfaceType::equirectangular, SurfaceType::spherical_mirror,
                                          SurfaceType::points};
/// "spherical-mirror"
char const* name_of(SurfaceType type);

/// Ellipse in a viewport: centre and half axes in fractions of its size.
struct ViewportCircle {
    double x = 0.5, y = 0.5, half_width = 0.5, half_height = 0.5;

    bool operator==(ViewportCircle const&) const = default;
};

/// The ball and what lights it, in the surface's frame.
struct SphericalMirror {
    gi::dvec3 center_m{0};
    double radius_m = 0;
    Placement projector; ///< its lens; looks along -Z
    std::array<double, 4> projector_tangents{-0.5, 0.5, -0.28125,
                                             0.28125}; ///< left, right, bottom, top of the picture

    bool operator==(SphericalMirror const&) const = default;
};

struct Surface {
    SurfaceType type = SurfaceType::fisheye;
    Placement place;      ///< centre and frame in the room
    double radius_m = 0;  ///< of the sphere or cylinder; 0 = so far away that the eye's place does not count
    double fov_deg = 180; ///< fisheye; spherical mirror: the lit part of the sphere, about -Z
    glm::dvec2 azimuths_deg{-180, 180};   ///< cylindrical, equirectangular: left, right
    glm::dvec2 elevations_deg{-90, 90};   ///< equirectangular: bottom, top
    glm::dvec2 heights_m{-1, 1};          ///< cylindrical: bottom, top
    std::optional<ViewportCircle> circle; ///< fisheye; none = the largest that fits, in the middle
    SphericalMirror mirror;
    MapFile points;    ///< points: of the frame, m, as parse_points() reads them
    double unit_m = 1; ///< of the points' file

    bool operator==(Surface const&) const = default;
};

/// A place in the room that a point of the viewport lights, or, with radius 0, the direction in which it lies.
struct SurfacePoint {
    gi::dvec3 at{0};
    bool is_direction = false;
};

/// @param aspect  width / height of the viewport. None: the point lights nothing of the surface.
std::optional<SurfacePoint> surface_point(Surface const& surface, double aspect, glm::dvec2 uv);
/// How far the surface is: its radius, or for points the distance of the nearest of some of them from `eye_m` (room), m;
/// 0 if it is infinitely far away or nothing is lit.
double distance_of(Surface const& surface, gi::dvec3 eye_m);
/// Unit vector in the room from an eye towards what the point shows; (0, 0, 0) for an eye at the point.
gi::dvec3 direction_to(SurfacePoint const& point, gi::dvec3 eye_m);

/// First value that cannot be, with the key in display files.
struct SurfaceFault {
    std::string key, problem, why, suggestion;
};
std::optional<SurfaceFault> find_fault(Surface const& surface);

} // namespace viewer
