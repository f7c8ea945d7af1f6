#pragma once
// First guesses of a pose, from rays alone.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"

#include <span>
#include <vector>

namespace ar {

enum class Shape {
    point, ///< fewer than two points that differ
    line,  ///< all on one: the camera may turn about it
    plane, ///< two poses explain the picture nearly as well (Schweighofer and Pinz 2006)
    solid  ///< in general position
};

/// Where points lie: their centre, axes by falling spread, and what they are.
struct PointSet {
    Shape shape = Shape::point;
    glm::dvec3 centre_m{0};
    glm::dmat3 axes{1};  ///< columns; right-handed
    double extent_m = 0; ///< root mean square distance from the centre
    int different = 0;   ///< points that are not at the place of another
};
PointSet survey(std::span<SightedPoint const> points);

/// Poses world_from_camera, unrefined, all with the points ahead. Planes: both solutions of IPPE (Collins and
/// Bartoli 2014), the better first, then SQPnP (Terzakis and Lourakis 2020); else SQPnP. Rays more than 80 degrees
/// from their mean are not used. Empty where nothing is found.
std::vector<Pose> candidates(CameraModel const& camera, std::span<SightedPoint const> points);

} // namespace ar
