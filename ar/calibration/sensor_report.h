#pragma once
// Writes the fitted sensor curves beside their data as one self-contained HTML page.

#include "ar/calibration/sensor.h"

#include <filesystem>
#include <optional>

namespace ar {

struct SensorReport {
    std::optional<VignettingFit> vignetting;
    std::optional<NoiseFit> noise;
    std::optional<ColourFit> colour;
    std::vector<cv::Vec3f> patches; ///< units of the chart's 24 patches that `colour` was fitted to
};

std::string to_html(SensorReport const& report);

/// @throws gi::InputError the file cannot be written
void write_report(std::filesystem::path const& file, SensorReport const& report);

} // namespace ar
