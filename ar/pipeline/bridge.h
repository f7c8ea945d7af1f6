#pragma once
// Converts between the types of ar and gi: cameras, pictures, environment maps.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "gi/image_io/picture.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/scene.h"

#include <opencv2/core.hpp>

namespace ar {

/// Converts a pinhole camera (distortion is ignored) with its pose. gi's cameras look along -z
/// with y up; ar's along z with y down. Pictures must have the camera's size.
gi::Camera gi_camera(CameraModel const& pinhole, gi::RigidPose const& world_from_camera);

/// A copy of a layer: CV_32FC3 or CV_32FC1. @throws std::invalid_argument no such layer
cv::Mat matrix_of(gi::Picture const& picture, std::string const& layer);

/// Converts CV_32FC3, RGB, lat-long (the same convention in both modules).
/// Negative and non-finite values become 0.
gi::EnvironmentMap environment_of(cv::Mat const& lat_long);

} // namespace ar
