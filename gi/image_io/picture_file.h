#pragma once
// Pictures on disk. Every writer goes to a temporary name beside the target and renames it when the file is
// complete, so a reader never sees half a picture.

#include "gi/core/report.h"
#include "gi/image_io/picture.h"

#include <filesystem>
#include <span>
#include <string>

namespace gi {

enum class PixelType { half, single };

/// OpenEXR. "color" becomes the channels R, G, B(, A) of the first part; every other layer NAME becomes
/// NAME.R/.G/.B (radiance-like), NAME.X/.Y/.Z ("normal", "position") or NAME.V (one channel).
/// Layers whose accuracy half floats would spoil ("depth", "position", "variance*") are always single.
/// Half values beyond +-65504 are clamped and counted in the report.
void write_exr(std::filesystem::path const& file, Picture const& picture, PixelType type, Report& report);

/// Any OpenEXR image: scan-line or tiled (level 0), one or several parts, half/float/uint, sub-sampled
/// channels rejected. Channels are grouped into layers by their name up to the last '.'; the group without a
/// prefix is "color". Throws InputError on unreadable, empty, oversized or non-image files.
Picture read_exr(std::filesystem::path const& file);
/// As above from memory; `name` is used in messages.
Picture decode_exr(std::span<unsigned char const> bytes, std::string const& name);
/// Radiance RGBE (.hdr), old and new run-length encoding.
Picture decode_hdr(std::span<unsigned char const> bytes, std::string const& name);

/// OpenEXR, Radiance HDR, or PNG, JPEG, TIFF, ... through OpenCV, told apart by their first bytes. 8 and 16-bit
/// files are sRGB-decoded to linear and give one layer "color"; HDR is taken as it is.
Picture read_picture(std::filesystem::path const& file);
/// As above from memory; `name` is used in messages.
Picture decode_picture(std::span<unsigned char const> bytes, std::string const& name);

/// 8-bit sRGB PNG. Three bytes a pixel, already display-encoded, or four: with alpha, which colours are not
/// multiplied by.
void write_png(std::filesystem::path const& file, int width, int height, std::span<unsigned char const> bytes);

} // namespace gi
