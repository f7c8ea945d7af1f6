#pragma once
// Composites beside pictures of the same camera with the things really there.

#include "ar/camera/pose.h"

#include <opencv2/core.hpp>

namespace viewer {

/// Means of FLIP (Andersson et al. 2020), 0 to 1.
struct TruthErrors {
    double flip_affected = 0;                         ///< where the truth is not what the camera saw
    double flip_elsewhere = 0;                        ///< where it is: whatever a composite changed there is wrong
    double affected = 0;                              ///< share of the picture
    double camera_affected = 0, camera_elsewhere = 0; ///< of the camera's frame: of adding nothing
};

/// CV_8UC1, 255 where bytes of the truth and of the camera's frame differ by more than 1 (2 % of radiance are one
/// or two; the sensor's noise is the same in both), grown by two pixels.
cv::Mat affected_by_truth(cv::Mat const& camera, cv::Mat const& truth);

/// All CV_8UC3 RGB (sRGB), of one size.
TruthErrors errors_against_truth(cv::Mat const& composite, cv::Mat const& camera, cv::Mat const& truth);

} // namespace viewer
