#include "viewer/displays/off_axis.h"

#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

bool is_usable(gi::dvec3 v)
{
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(v[i]) <= kFarthestCorner_m)) return false; // also NaN
    return true;
}

/// Deviation of the corners from a right angle, degrees.
double skew_of(gi::dvec3 across, gi::dvec3 upward)
{
    return std::abs(glm::degrees(std::atan2(glm::dot(across, upward), glm::length(glm::cross(across, upward)))));
}

} // namespace

std::optional<CornerFault> find_fault(WallCorners const& c)
{
    if (!is_usable(c.lower_left) || !is_usable(c.lower_right) || !is_usable(c.upper_left))
        return CornerFault{"a corner is not finite or farther than 10,000 km",
                           "a wall has its corners somewhere in the room", "give three points in metres"};
    gi::dvec3 const across = c.lower_right - c.lower_left, upward = c.upper_left - c.lower_left;
    double const width = glm::length(across), height = glm::length(upward);
    if (width < kShortestEdge_m || height < kShortestEdge_m ||
        glm::length(glm::cross(across, upward)) < 1e-6 * width * height)
        return CornerFault{"the corners span no area", "two of them coincide or all three lie on one line",
                           "give lower left, lower right and upper left, in metres"};
    if (double const skew = skew_of(across, upward); skew > kSkew_deg)
        return CornerFault{fmt::format("the edges meet at {:.4g} degrees", 90 - skew),
                           "a wall is a rectangle; a picture would be sheared",
                           "measure again; warp corrects a skewed projection"};
    return {};
}

WallFrame wall_frame(WallCorners const& c)
{
    if (auto const fault = find_fault(c)) throw gi::InputError(fault->problem, fault->why, fault->suggestion);
    gi::dvec3 const across = c.lower_right - c.lower_left, upward = c.upper_left - c.lower_left;
    WallFrame wall;
    wall.lower_left = c.lower_left;
    wall.width_m = glm::length(across);
    wall.right = across / wall.width_m;
    wall.normal = glm::normalize(glm::cross(wall.right, upward));
    wall.up = glm::cross(wall.normal, wall.right);
    wall.height_m = glm::dot(upward, wall.up);
    wall.skew_deg = skew_of(across, upward);
    return wall;
}

char const* name_of(EyePlace place)
{
    switch (place) {
    case EyePlace::before:
        return "before";
    case EyePlace::too_near:
        return "too near";
    case EyePlace::behind:
        return "behind";
    case EyePlace::unknown:
        break;
    }
    return "unknown";
}

EyePlace place_of(gi::dvec3 eye, WallFrame const& wall)
{
    double const distance = glm::dot(eye - wall.lower_left, wall.normal);
    if (!std::isfinite(glm::dot(eye, eye)) || !std::isfinite(distance)) return EyePlace::unknown;
    double const nearest = kNearestEye * std::max(wall.width_m, wall.height_m);
    if (distance >= nearest) return EyePlace::before;
    return distance > -nearest ? EyePlace::too_near : EyePlace::behind;
}

std::optional<gi::Camera> off_axis_camera(gi::dvec3 eye, WallFrame const& wall)
{
    if (place_of(eye, wall) != EyePlace::before) return {};
    gi::dvec3 const from_corner = eye - wall.lower_left;
    double const distance = glm::dot(from_corner, wall.normal);
    double const across = glm::dot(from_corner, wall.right), upward = glm::dot(from_corner, wall.up);
    gi::Camera camera;
    camera.off_axis = gi::ViewTangents{-across / distance, (wall.width_m - across) / distance, -upward / distance,
                                       (wall.height_m - upward) / distance};
    camera.yfov_rad = std::atan(camera.off_axis->top) - std::atan(camera.off_axis->bottom);
    camera.aspect = wall.width_m / wall.height_m;
    camera.world_from_camera = gi::dmat4(glm::dvec4(wall.right, 0), glm::dvec4(wall.up, 0),
                                         glm::dvec4(wall.normal, 0), glm::dvec4(eye, 1));
    return camera;
}

} // namespace viewer
