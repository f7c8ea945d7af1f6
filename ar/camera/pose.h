#pragma once
// Poses. Lengths in metres. A camera's frame is OpenCV's: x right, y down, z along the viewing direction. The
// world is right-handed with y up. A pose is named by its frames: `world_from_camera` maps points from the
// camera's frame to the world's.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <opencv2/core.hpp>

namespace ar {

struct Pose {
    glm::dquat rotation{1, 0, 0, 0}; ///< of length 1
    glm::dvec3 position_m{0};

    friend bool operator==(Pose const&, Pose const&) = default;
};

glm::dvec3 operator*(Pose const& a_from_b, glm::dvec3 point_b);
Pose operator*(Pose const& a_from_b, Pose const& b_from_c);
Pose inverse(Pose const& a_from_b);

/// Pose camera_from_object from the rotation vector (axis times angle in radians)
/// and translation of OpenCV's solvePnP.
Pose pose_of(cv::Vec3d const& rotation_vector, cv::Vec3d const& translation_m);
cv::Vec3d rotation_vector(Pose const& p);

/// The angle between two orientations, 0 to 180 degrees.
double angle_between_deg(glm::dquat const& a, glm::dquat const& b);

} // namespace ar
