#pragma once
// Environment maps on disk: OpenEXR (R, G, B; or Y), Radiance (.hdr), PNG (8 or 16 bits, sRGB: no light above 1).

#include <filesystem>
#include <opencv2/core.hpp>

namespace ar {

/// CV_32FC3, RGB. @throws gi::InputError not readable, no such channels, more than 16384 texels wide, or refused
/// by check_map
cv::Mat read_map(std::filesystem::path const& file);
/// Any CV_32FC3 picture from the same formats, of any shape; values as they are.
cv::Mat read_radiance(std::filesystem::path const& file);
/// By the file's ending: .exr (32 bit float), .hdr (8 bits of mantissa), .png (8 bits, clipped to 0..1).
/// @throws gi::InputError not writable, or refused by check_map
void write_map(std::filesystem::path const& file, cv::Mat const& map);

} // namespace ar
