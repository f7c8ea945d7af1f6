#pragma once
// Whether the pictures of markers contradict the calibration's focal length: a plane seen at a slant shows it (Zhang
// 2000), so a calibration of another zoom, camera or picture size leaves residuals that another focal length does not.

#include "ar/camera/camera_model.h"
#include "ar/camera/sighting.h"

#include <optional>
#include <string>
#include <vector>

namespace ar {

struct FocalFinding {
    double scale = 1;  ///< of the focal length that fits best, relative to the camera's
    double own_px = 0; ///< root mean square of the reprojection errors by the calibration (truncated)
    double best_px = 0;
    int views = 0;
};

/// Fits each view with focal lengths of half to twice the camera's. @return nothing if the camera's fits nearly as
/// well as the best, within 3 % of it, or the views do not tell (too few, seen from the front)
std::optional<FocalFinding> contradicted_focal_length(CameraModel const& camera,
                                                      std::vector<Sighting> const& views);

/// "the markers' pictures fit a focal length of 556 px (0.1 px RMS), the calibration has 700 (1.2 px)".
std::string describe(FocalFinding const& finding, CameraModel const& camera);

} // namespace ar
