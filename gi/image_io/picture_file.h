#pragma once
// Picture files. Every writer writes to a temporary file beside the target and renames it when complete, so a
// reader never sees half a picture.

#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/image_io/picture_rows.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace gi {

enum class PixelType { half, single };

enum class ExrCompression { zip, none };

/// Standard attributes of OpenEXR that a film's pictures have; empty ones are left out.
struct ExrAttributes {
    double frames_per_s = 0; ///< 0 = none
    struct TimeCode {
        int hours = 0, minutes = 0, seconds = 0;
        int frame = 0;                ///< 0..29
        bool is_second_field = false; ///< above 30 frames per second two frames share a number (SMPTE ST 12-1)
    };
    std::optional<TimeCode> time_code = {};
    /// Points of the world to those of a camera that looks along -z with y up, and to its picture, -1..1 each way.
    std::optional<dmat4> world_to_camera = {}, world_to_ndc = {};
    ExrCompression compression = ExrCompression::zip;
    StopRequest const* stop = nullptr; ///< once it is requested, writing throws Interrupted and leaves no file
};

/// SMPTE time code of a frame; drop-frame counting is not used: at 29.97 Hz the code runs as at 30. Nothing above
/// 60 Hz, of rates that are not known (0), and after 24 hours.
std::optional<ExrAttributes::TimeCode> time_code_of(std::uint64_t frame, double frames_per_s);

/// OpenEXR. "color" becomes the channels R, G, B(, A) of the first part; every other layer NAME becomes
/// NAME.R/.G/.B (radiance-like), NAME.X/.Y/.Z ("normal", "position") or NAME.V (one channel).
/// NAME.X, NAME.Y for "motion_*". Layers that need more accuracy than half floats ("depth*",
/// "position", "variance*", "motion_*") are always single precision. Half values beyond +-65504
/// are clamped and counted in the report.
void write_exr(std::filesystem::path const& file, Picture const& picture, PixelType type, Report& report,
               ExrAttributes const& attributes = {});
/// The same picture, read kRowsAtOnce rows at a time: the same file, in little memory.
void write_exr(std::filesystem::path const& file, PictureRows const& picture, PixelType type, Report& report,
               ExrAttributes const& attributes = {});

/// Reads any OpenEXR image: scan-line or tiled (level 0), one or several parts, half/float/uint. The picture is the
/// display window (openexr.com, "Technical Introduction"): 0 outside of the data window, data beyond it are cut; of
/// environments (attribute envmap) it is the data window. Channels are grouped into layers by their name up to the
/// last '.' (exr_layers.h); R, G, B(, A), Y(, A), or Y with RY and BY without a layer are "color", of the first part
/// that has them; layers of later parts with names that are taken get their part's: PART.LAYER. Values are as
/// written, in the primaries of the file. Deep parts beside others are left out. What was chosen, cut or left out is in
/// the notes. Throws InputError on unreadable, empty, oversized or non-image files.
Picture read_exr(std::filesystem::path const& file);
/// As above from memory; `name` is used in messages.
Picture decode_exr(std::span<unsigned char const> bytes, std::string const& name);
/// Radiance RGBE (.hdr), old and new run-length encoding.
Picture decode_hdr(std::span<unsigned char const> bytes, std::string const& name);

/// OpenEXR, Radiance HDR, or PNG, JPEG, TIFF, ... through OpenCV, distinguished by their first bytes. 8-bit
/// and 16-bit files are sRGB-decoded to linear and give one layer "color"; HDR values are kept as they are, but for
/// the layer "color" of OpenEXR files with other chromaticities, which is converted to Rec. 709.
Picture read_picture(std::filesystem::path const& file);
/// As above from memory; `name` is used in messages.
Picture decode_picture(std::span<unsigned char const> bytes, std::string const& name);
/// As above, but values of 8 and 16 bits are as they are stored, 0..1: of pictures whose values are no sRGB colours.
Picture decode_stored(std::span<unsigned char const> bytes, std::string const& name);

/// 8-bit sRGB PNG. Three display-encoded bytes per pixel, or four with alpha (colours not premultiplied).
void write_png(std::filesystem::path const& file, int width, int height, std::span<unsigned char const> bytes);
/// The same, kRowsAtOnce rows at a time, which `rows` gives as such bytes.
void write_png(std::filesystem::path const& file, int width, int height,
               std::function<std::vector<unsigned char>(int first, int count)> const& rows);

} // namespace gi
