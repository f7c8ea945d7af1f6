#pragma once
// Converts the memory that a camera's driver wrote to planes of a Frame. Formats are named by their DRM codes
// (four letters, drm_fourcc.h), as in libcamera: components from the highest bits of a little-endian word to the
// lowest, so RGB888 is B, G, R in memory.

#include "ar/camera/frame.h"

#include <optional>
#include <span>

namespace ar {

struct CameraPixels {
    std::uint32_t fourcc = 0;
    PixelFormat format = PixelFormat::rgb8; ///< of the frames
    bool is_copied = false; ///< true if bytes must be reordered, so planes are copies of the camera's memory
};

constexpr std::uint32_t fourcc(char const (&name)[5])
{
    return std::uint32_t(std::uint8_t(name[0])) | std::uint32_t(std::uint8_t(name[1])) << 8 |
           std::uint32_t(std::uint8_t(name[2])) << 16 | std::uint32_t(std::uint8_t(name[3])) << 24;
}
/// The code as text, for example "NV12"; unprintable bytes become '?'.
std::string name_of_fourcc(std::uint32_t code);

/// All readable formats, cheapest first.
std::span<CameraPixels const> camera_pixels();
std::optional<CameraPixels> camera_pixels_of(std::uint32_t fourcc);

/// Bytes of each plane of a buffer that the camera fills.
/// @param frame_bytes bytes of all planes, as reported by the camera; used for compressed formats
std::vector<std::size_t> plane_bytes(std::uint32_t fourcc, glm::ivec2 size_px, std::size_t stride,
                                     std::size_t frame_bytes);

/// Sets format, size and planes of a frame.
/// @param stride bytes from one row of the first plane to the next
/// @param memory one span per plane, with the bytes that were written; consecutive planes may share one span.
/// If nothing is copied, the frame's planes point into it
/// @return empty, or the reason for refusing the frame
std::string set_planes(Frame& frame, std::uint32_t fourcc, glm::ivec2 size_px, std::size_t stride,
                       std::span<std::span<std::uint8_t const> const> memory);

} // namespace ar
