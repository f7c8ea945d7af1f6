#pragma once
// Lens models from views of a board (Zhang 2000, through OpenCV), how sure they are, and which one to take.

#include "ar/calibration/board_view.h"

namespace ar {

struct ViewResult {
    std::string name;
    Pose camera_from_board;
    double rms_px = 0;
    std::vector<glm::dvec2> residuals_px; ///< seen minus projected, in the order of the view's points
    bool used = true;
    std::string why; ///< it was left out
};

struct LensCalibration {
    CameraModel camera;
    double rms_px = 0;             ///< over all points of the views used
    std::vector<ViewResult> views; ///< as given
    /// fx fy cx cy and the coefficients of the lens, n of them.
    std::vector<std::string> parameters;
    /// n x n, CV_64F: of these, from the Jacobian at the solution (poses eliminated) and the residuals' variance.
    cv::Mat covariance;
    std::vector<double> standard_deviations;
    double coverage = 0; ///< share of an 8 x 6 grid of the picture where a view has points
    std::vector<std::string> warnings;

    int used_views() const;
};

struct LensOptions {
    /// Views whose RMS error is more than this times the median's are left out, one after the other, at most a
    /// third of all; 0: none.
    double outlier_factor = 3;
    /// Of an error below this no view is left out, pixels.
    double outlier_floor_px = 0.25;
};

/// @throws gi::InputError fewer than three views with six points, or numbers that no lens fits
LensCalibration calibrate_lens(std::vector<BoardView> const& views, glm::ivec2 size_px, LensModel lens,
                               LensOptions const& options = {});

/// Values of fx fy cx cy and the lens's coefficients, and the camera with other ones.
std::vector<double> parameters_of(CameraModel const& camera);
CameraModel with_parameters(CameraModel camera, std::vector<double> const& values);

/// fx fy cx cy k1 ...
std::vector<std::string> parameter_names(LensModel lens);

/// CV_64F, parameters x parameters. @param poses of the views
cv::Mat covariance_of(CameraModel const& camera, std::vector<BoardView> const& views,
                      std::vector<Pose> const& poses);

/// Share of the cells of an 8 x 6 grid over the picture that have a point.
double coverage_of(std::vector<BoardView> const& views, glm::ivec2 size_px);

} // namespace ar
