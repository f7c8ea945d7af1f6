#pragma once
// Environment maps on disk: OpenEXR (R, G, B; or Y), Radiance (.hdr), PNG (8 or 16 bits, sRGB: no light above 1).

#include "gi/core/report.h"

#include <filesystem>
#include <opencv2/core.hpp>

namespace ar {

/// Returns CV_32FC3, RGB. @throws gi::InputError if unreadable, without such channels, more than 16384 texels
/// wide, or refused by check_map. @param report  what was cut, chosen or converted (Picture::notes); null = nobody asks
cv::Mat read_map(std::filesystem::path const& file, gi::Report* report = nullptr);
/// Reads a picture of any shape from the same formats as CV_32FC3, values unchanged.
cv::Mat read_radiance(std::filesystem::path const& file, gi::Report* report = nullptr);
/// Writes by file extension: .exr (32 bit float), .hdr (8 bits of mantissa), .png (8 bits, clipped to 0..1).
/// @throws gi::InputError if the file cannot be written, or the map is refused by check_map
void write_map(std::filesystem::path const& file, cv::Mat const& map);

} // namespace ar
