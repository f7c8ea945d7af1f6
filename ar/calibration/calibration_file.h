#pragma once
// A camera's calibration as one YAML file that cv::FileStorage can read too: camera_matrix,
// distortion_coefficients, image_width and image_height are stored as OpenCV's own programs store them.

#include "ar/calibration/sensor.h"
#include "ar/camera/camera_model.h"
#include "ar/camera/photometry.h"
#include "gi/core/report.h"

#include <filesystem>
#include <optional>

namespace ar {

struct Calibration {
    CameraModel camera;
    double rms_px = 0; ///< reprojection error; 0: unknown
    /// Covariance of fx fy cx cy and the coefficients, n x n, CV_64F; empty: unknown.
    cv::Mat covariance;
    std::optional<Photometry> photometry;
    std::optional<NoiseModel> noise;
    std::filesystem::path stmap; ///< of the lens stmap: its file
    /// How the calibration was made: key and value; keys consist of letters, digits and _.
    std::vector<std::pair<std::string, std::string>> provenance;
};

/// Also reads OpenCV files that have only camera_matrix and distortion_coefficients (or dist_coeffs): 0
/// coefficients mean pinhole, 4 or 5 radial_tangential, 8 rational, unless lens_model, the distortion_model of ROS
/// (none or pinhole, plumb_bob or radtan, rational_polynomial, equidistant or fisheye) or OpenCV's fisheye_model states another model. The key `stmap` names an STMap (ar/calibration/stmap.h), relative to the file, that
/// replaces the coefficients; `parse` leaves the lens a pinhole, `read` reads the map. The picture's size may be
/// image_width and image_height, or image_size.
/// @param file name of the file for messages
/// @param size_px used if the file states no size. @throws gi::InputError with file:line:column: not YAML,
/// matrices of wrong sizes, numbers that are not finite, lens models that are unknown or do not fit the
/// coefficients, decreasing response curves, cameras that `check` refuses
Calibration parse_calibration(std::string const& text, std::string const& file,
                              std::optional<glm::ivec2> size_px = std::nullopt);
std::string format_calibration(Calibration const& calibration);

/// @param report  if not null: as with_stmap. @throws gi::InputError
Calibration read_calibration(std::filesystem::path const& file, std::optional<glm::ivec2> size_px = std::nullopt,
                             gi::Report* report = nullptr);
/// Writes atomically: if writing fails, the old file remains. @throws gi::InputError
void write_calibration(std::filesystem::path const& file, Calibration const& calibration);

} // namespace ar
