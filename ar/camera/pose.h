#pragma once
// Poses of cameras, as gi::RigidPose. A camera's frame is OpenCV's: x right, y down, z along the viewing direction. The
// world is right-handed with y up. A pose is named by its frames: `world_from_camera` maps points from the
// camera's frame to the world's.

#include "gi/core/pose.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <opencv2/core.hpp>

namespace ar {

/// Pose camera_from_object from the rotation vector (axis times angle in radians)
/// and translation of OpenCV's solvePnP.
gi::RigidPose pose_of(cv::Vec3d const& rotation_vector, cv::Vec3d const& translation_m);
cv::Vec3d rotation_vector(gi::RigidPose const& p);

/// The angle between two orientations, 0 to 180 degrees.
double angle_between_deg(glm::dquat const& a, glm::dquat const& b);

} // namespace ar
