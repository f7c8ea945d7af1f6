#pragma once
// Maps of calibrations: three numbers for each pixel of a viewport, rows from the top. A map of another size than the
// viewport is stretched over it; its values are at the middles of its pixels, linear between them.

#include "gi/core/math.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer {

inline constexpr int kLargestMap_px = 16384; ///< along one side

struct PixelMap {
    int width = 0, height = 0;
    std::vector<glm::vec3> values; ///< width * height; NaN = none

    glm::vec3 const& at(int x, int y) const
    {
        return values[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    }
};

/// A map and where it is from. Copies share the map.
struct MapFile {
    std::string file; ///< path as written in the display file
    std::shared_ptr<PixelMap const> map;

    bool operator==(MapFile const& other) const; ///< the same file and the same values
};

/// A picture of factors on light, or of light, as the projector's pixels show it.
struct LightMap {
    MapFile light;    ///< 0..1 of the projector's full light, red, green and blue; linear
    double gamma = 1; ///< of the file: light = value^gamma

    bool operator==(LightMap const&) const = default;
};

bool has_value(glm::vec3 const& value);
/// The value at a place of the viewport, 0 to 1 from the lower left corner; values that are none do not count.
/// None where those that are weigh less than half.
std::optional<glm::dvec3> value_at(PixelMap const& map, glm::dvec2 uv);

/// Portable float map (P. Debevec): "PF", width and height, a scale, then three 32-bit floats a pixel, rows from
/// below; little-endian if the scale is negative. The scale's magnitude is not used. Throws InputError on others, on
/// "Pf" (one number a pixel), sizes that do not match the file, infinite values, and if no pixel has a value.
/// @param name  for messages
PixelMap parse_pfm(std::span<unsigned char const> bytes, std::string const& name);
/// The same in bytes, little-endian.
std::vector<unsigned char> pfm_bytes(PixelMap const& map);
/// Where each pixel of a viewport takes its colour: x and y in the picture from its upper left corner, 0 to 1 (VESA
/// MPCDI, profile 2d). Beyond that it is black; NaN, or (0, 0): the pixel stays dark. Throws InputError as
/// parse_pfm(), and on positions beyond 1e6.
PixelMap parse_picture_positions(std::span<unsigned char const> bytes, std::string const& name);
/// Which point of the room, or of a surface's frame, each pixel lights, in metres; NaN, or (0, 0, 0): none. Throws
/// InputError as parse_pfm(), and on points beyond 1000 km.
/// @param unit_m  of the file, m
PixelMap parse_points(std::span<unsigned char const> bytes, double unit_m, std::string const& name);
/// Light of a picture with 8 or 16 bits (PNG, ...), value^gamma.
PixelMap parse_light(std::span<unsigned char const> bytes, double gamma, std::string const& name);

/// The whole file. Throws InputError if there is none, or beyond 1 GiB.
std::vector<unsigned char> read_map_bytes(std::filesystem::path const& file);

} // namespace viewer
