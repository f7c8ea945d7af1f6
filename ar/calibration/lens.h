#pragma once
// Fits lens models to views of a board (Zhang 2000, through OpenCV), with their uncertainty.

#include "ar/calibration/board_view.h"

namespace ar {

struct ViewResult {
    std::string name;
    gi::RigidPose camera_from_board;
    double rms_px = 0;
    std::vector<glm::dvec2> residuals_px; ///< observed minus projected, in the order of the view's points
    bool used = true;
    std::string why; ///< reason if it was left out
};

struct LensCalibration {
    CameraModel camera;
    double rms_px = 0;             ///< over all points of the views used
    std::vector<ViewResult> views; ///< as given
    /// Names of the n parameters: fx fy cx cy and the lens's coefficients.
    std::vector<std::string> parameters;
    /// Covariance of the parameters, n x n, CV_64F, from the Jacobian at the solution (poses eliminated) and the
    /// variance of the residuals.
    cv::Mat covariance;
    std::vector<double> standard_deviations;
    double coverage = 0; ///< share of the cells of an 8 x 6 grid over the picture that have a point
    std::vector<std::string> warnings;

    int used_views() const;
};

struct LensOptions {
    /// Views whose RMS error exceeds this multiple of the median are left out, one at a time,
    /// at most a third of all; 0: none.
    double outlier_factor = 3;
    /// Views with an RMS error below this (pixels) are never left out.
    double outlier_floor_px = 0.25;
};

/// @throws gi::InputError fewer than three views with six points, or numbers that no lens fits
LensCalibration calibrate_lens(std::vector<BoardView> const& views, glm::ivec2 size_px, LensModel lens,
                               LensOptions const& options = {});

/// Returns fx fy cx cy and the lens's coefficients; `with_parameters` returns the camera with these replaced.
std::vector<double> parameters_of(CameraModel const& camera);
CameraModel with_parameters(CameraModel camera, std::vector<double> const& values);

/// fx fy cx cy k1 ...
std::vector<std::string> parameter_names(LensModel lens);

/// Covariance of the parameters: CV_64F, parameters x parameters. @param poses one per view
cv::Mat covariance_of(CameraModel const& camera, std::vector<BoardView> const& views,
                      std::vector<gi::RigidPose> const& poses);

/// Share of the cells of an 8 x 6 grid over the picture that have a point.
double coverage_of(std::vector<BoardView> const& views, glm::ivec2 size_px);

} // namespace ar
