#pragma once
// Writes the fitted sensor curves beside their data as one self-contained HTML page.

#include "ar/calibration/sensor.h"

#include <optional>

namespace ar {

struct SensorReport {
    std::optional<VignettingFit> vignetting;
    std::optional<NoiseFit> noise;
    std::optional<ColourFit> colour;
    std::vector<cv::Vec3f> patches; ///< units of the chart's 24 patches that `colour` was fitted to
};

std::string to_html(SensorReport const& report);

} // namespace ar
