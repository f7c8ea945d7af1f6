#pragma once
// Maps of calibrations as files.

#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "viewer/displays/pixel_map.h"

#include <functional>

namespace viewer::test {

/// @param value  of a place in the viewport, 0 to 1 from the upper left
inline PixelMap made_map(int width, int height, std::function<glm::vec3(glm::dvec2)> const& value)
{
    PixelMap map{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) map.values.push_back(value({(x + 0.5) / width, (y + 0.5) / height}));
    return map;
}

inline std::string text_of(std::vector<unsigned char> const& bytes) { return {bytes.begin(), bytes.end()}; }

inline std::vector<unsigned char> bytes_of(std::string const& text) { return {text.begin(), text.end()}; }

/// A grey PNG of 8 bits; `value` as of made_map(), 0 to 1.
inline void write_grey(std::filesystem::path const& file, int width, int height,
                       std::function<double(glm::dvec2)> const& value)
{
    std::vector<unsigned char> rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            rgb.insert(
                rgb.end(), 3,
                static_cast<unsigned char>(std::lround(255 * value({(x + 0.5) / width, (y + 0.5) / height}))));
    gi::write_png(file, width, height, rgb);
}

} // namespace viewer::test
