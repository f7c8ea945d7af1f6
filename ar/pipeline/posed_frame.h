#pragma once
// A camera's frame with a known pose, from which light and albedos are estimated.

#include "ar/camera/photometry.h"
#include "ar/camera/pose.h"

namespace ar {

/// A frame without virtual objects.
struct PosedFrame {
    cv::Mat rgb; ///< as picture_of, of the calibration's size
    Exposure exposure;
    gi::RigidPose world_from_camera;
    double confidence = 1; ///< of the pose
};

} // namespace ar
