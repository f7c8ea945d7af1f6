#pragma once
// What a camera's driver wrote into memory, as planes of a Frame. Formats are named by their DRM codes (four
// letters, drm_fourcc.h), which libcamera uses: components from the highest bits of a little-endian word to the
// lowest, so that RGB888 is B, G, R in memory.

#include "ar/camera/frame.h"

#include <optional>
#include <span>

namespace ar {

struct CameraPixels {
    std::uint32_t fourcc = 0;
    PixelFormat format = PixelFormat::rgb8; ///< of the frames
    bool is_copied = false; ///< their planes are not the camera's memory: bytes have to be reordered
};

constexpr std::uint32_t fourcc(char const (&name)[5])
{
    return std::uint32_t(std::uint8_t(name[0])) | std::uint32_t(std::uint8_t(name[1])) << 8 |
           std::uint32_t(std::uint8_t(name[2])) << 16 | std::uint32_t(std::uint8_t(name[3])) << 24;
}
/// "NV12"; what is no letter as '?'.
std::string name_of_fourcc(std::uint32_t code);

/// All that can be read, those first that cost the least.
std::span<CameraPixels const> camera_pixels();
std::optional<CameraPixels> camera_pixels_of(std::uint32_t fourcc);

/// Bytes of each plane of a buffer that a camera is to fill.
/// @param frame_bytes of all planes, as the camera says; what compressed formats need
std::vector<std::size_t> plane_bytes(std::uint32_t fourcc, glm::ivec2 size_px, std::size_t stride,
                                     std::size_t frame_bytes);

/// Sets format, size and planes of a frame.
/// @param stride bytes from one row of the first plane to the next
/// @param memory each plane's, as many bytes as were written; planes may also follow each other in one. Where
/// nothing is copied, the frame's planes point into it
/// @return empty, or why the frame has to be refused
std::string set_planes(Frame& frame, std::uint32_t fourcc, glm::ivec2 size_px, std::size_t stride,
                       std::span<std::span<std::uint8_t const> const> memory);

} // namespace ar
