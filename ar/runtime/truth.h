#pragma once
// Compares composites with pictures of the same camera with the objects really there.

#include "ar/camera/pose.h"

#include <opencv2/core.hpp>
#include <optional>

namespace ar {

/// Means of FLIP (Andersson et al. 2020), 0 to 1; nothing: over no pixel.
struct TruthErrors {
    std::optional<double> flip_affected;                     ///< where the truth differs from the camera's frame
    std::optional<double> flip_elsewhere;                    ///< elsewhere: any change there is an error
    double affected = 0;                                     ///< share of the picture
    std::optional<double> camera_affected, camera_elsewhere; ///< of the unchanged camera frame
    bool equals_camera = false;                              ///< the truth is the camera's frame, byte for byte
};

/// CV_8UC1, 255 where bytes of the truth and of the camera's frame differ by more than 1 (2 % of radiance are one
/// or two; the sensor's noise is the same in both), grown by two pixels.
cv::Mat affected_by_truth(cv::Mat const& camera, cv::Mat const& truth);

/// All pictures CV_8UC3 RGB (sRGB), of the same size.
TruthErrors errors_against_truth(cv::Mat const& composite, cv::Mat const& camera, cv::Mat const& truth);

} // namespace ar
