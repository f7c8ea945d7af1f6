#pragma once
// A camera's frame with a known pose, from which light and albedos are estimated.

#include "ar/camera/photometry.h"
#include "ar/camera/pose.h"

namespace viewer {

/// A frame without virtual objects.
struct PosedFrame {
    cv::Mat rgb; ///< as ar::picture_of, of the calibration's size
    ar::Exposure exposure;
    ar::Pose world_from_camera;
    double confidence = 1; ///< of the pose
};

} // namespace viewer
