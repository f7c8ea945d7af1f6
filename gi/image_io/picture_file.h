#pragma once
// Picture files. Every writer writes to a temporary file beside the target and renames it when complete, so a
// reader never sees half a picture.

#include "gi/core/report.h"
#include "gi/image_io/picture.h"

#include <filesystem>
#include <span>
#include <string>

namespace gi {

enum class PixelType { half, single };

/// OpenEXR. "color" becomes the channels R, G, B(, A) of the first part; every other layer NAME becomes
/// NAME.R/.G/.B (radiance-like), NAME.X/.Y/.Z ("normal", "position") or NAME.V (one channel).
/// Layers that need more accuracy than half floats ("depth", "position", "variance*") are always single precision.
/// Half values beyond +-65504 are clamped and counted in the report.
void write_exr(std::filesystem::path const& file, Picture const& picture, PixelType type, Report& report);

/// Reads any OpenEXR image: scan-line or tiled (level 0), one or several parts, half/float/uint; sub-sampled
/// channels are rejected. Channels are grouped into layers by their name up to the last '.'; the group without a
/// prefix is "color". Throws InputError on unreadable, empty, oversized or non-image files.
Picture read_exr(std::filesystem::path const& file);
/// As above from memory; `name` is used in messages.
Picture decode_exr(std::span<unsigned char const> bytes, std::string const& name);
/// Radiance RGBE (.hdr), old and new run-length encoding.
Picture decode_hdr(std::span<unsigned char const> bytes, std::string const& name);

/// OpenEXR, Radiance HDR, or PNG, JPEG, TIFF, ... through OpenCV, distinguished by their first bytes. 8-bit
/// and 16-bit files are sRGB-decoded to linear and give one layer "color"; HDR values are kept as they are.
Picture read_picture(std::filesystem::path const& file);
/// As above from memory; `name` is used in messages.
Picture decode_picture(std::span<unsigned char const> bytes, std::string const& name);

/// 8-bit sRGB PNG. Three display-encoded bytes per pixel, or four with alpha (colours not premultiplied).
void write_png(std::filesystem::path const& file, int width, int height, std::span<unsigned char const> bytes);

} // namespace gi
