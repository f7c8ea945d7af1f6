#pragma once
// Initial estimates of a pose, from rays alone.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"

#include <span>
#include <vector>

namespace ar {

enum class Shape {
    point, ///< fewer than two points that differ
    line,  ///< all on one line: rotation about it is undetermined
    plane, ///< two poses explain the picture nearly as well (Schweighofer and Pinz 2006)
    solid  ///< in general position
};

/// Distribution of points: their centre, principal axes by decreasing spread, and shape.
struct PointSet {
    Shape shape = Shape::point;
    glm::dvec3 centre_m{0};
    glm::dmat3 axes{1};  ///< columns; right-handed
    double extent_m = 0; ///< root mean square distance from the centre
    int different = 0;   ///< number of distinct points
};
PointSet survey(std::span<SightedPoint const> points);

/// Unrefined poses world_from_camera with all points in front of the camera. Planes: both solutions of IPPE
/// (Collins and Bartoli 2014), the better first, then SQPnP (Terzakis and Lourakis 2020); else SQPnP. Rays more
/// than 80 degrees from their mean are not used. Empty if none is found.
std::vector<gi::RigidPose> candidates(CameraModel const& camera, std::span<SightedPoint const> points);

} // namespace ar
