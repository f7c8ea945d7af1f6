#pragma once
// Depth maps as files: metres along the camera's axis.

#include "gi/core/report.h"

#include <filesystem>
#include <opencv2/core.hpp>

namespace ar {

/// CV_32FC1, metres; 0 and non-finite values: no surface. EXR: the layer `depth`, or the only channel without a
/// layer, Z or Y; PNG of 16 bits.
/// @param metres_per_unit  0 = 1 for EXR, 0.001 for PNG
/// @param report  if not null: what was cut or left out of the file, and where depth is unknown
/// @throws gi::InputError the file cannot be read, or holds no depths
cv::Mat read_depth_map(std::filesystem::path const& file, double metres_per_unit, gi::Report* report = nullptr);

} // namespace ar
