#pragma once
// Writes a calibration as one self-contained HTML page: residuals over the picture, coverage, views, parameters
// with their standard deviations, response curves.

#include "ar/calibration/calibration_file.h"
#include "ar/calibration/lens_choice.h"

namespace ar {

struct CalibrationReport {
    LensCalibration lens;
    std::vector<BoardView> views; ///< as given to calibrate_lens
    std::optional<LensChoice> choice;
    std::optional<Photometry> photometry;
    std::optional<NoiseModel> noise;
    /// A picture shown dimmed beneath the residuals, CV_8UC3 (RGB) or CV_8UC1; may be empty.
    cv::Mat background;
};

std::string to_html(CalibrationReport const& report);

} // namespace ar
