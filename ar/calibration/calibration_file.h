#pragma once
// All that is known of a camera as one YAML file that cv::FileStorage reads, too: camera_matrix,
// distortion_coefficients, image_width and image_height are where OpenCV's own programs have them.

#include "ar/calibration/sensor.h"
#include "ar/camera/camera_model.h"
#include "ar/camera/photometry.h"

#include <filesystem>
#include <optional>

namespace ar {

struct Calibration {
    CameraModel camera;
    double rms_px = 0; ///< reprojection error; 0: not said
    /// n x n, CV_64F, of fx fy cx cy and the coefficients; empty: not said.
    cv::Mat covariance;
    std::optional<Photometry> photometry;
    std::optional<NoiseModel> noise;
    /// Where it comes from: key and value, keys of letters, digits and _.
    std::vector<std::pair<std::string, std::string>> provenance;
};

/// Files of OpenCV that have only camera_matrix and distortion_coefficients (or dist_coeffs) are read as well: 0
/// coefficients are a pinhole, 4 or 5 radial_tangential, 8 rational, unless lens_model or OpenCV's fisheye_model
/// says otherwise; the picture's size may be image_width and image_height or image_size.
/// @param file for messages
/// @param size_px taken where the file says none. @throws gi::InputError with file:line:column: not YAML, matrices
/// of wrong sizes, numbers that are not finite, lens models that are unknown or do not fit the coefficients,
/// curves that fall, cameras that `check` refuses
Calibration parse_calibration(std::string const& text, std::string const& file,
                              std::optional<glm::ivec2> size_px = std::nullopt);
std::string format_calibration(Calibration const& calibration);

/// @throws gi::InputError
Calibration read_calibration(std::filesystem::path const& file, std::optional<glm::ivec2> size_px = std::nullopt);
/// Whole, or as it was before. @throws gi::InputError
void write_calibration(std::filesystem::path const& file, Calibration const& calibration);

} // namespace ar
