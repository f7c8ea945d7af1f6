#pragma once
// Draws a set of directions as a picture, to judge how evenly they cover the sphere.

#include "gi/hit_buffers/directions/directions.h"

#include <cstdint>

namespace gi {

/// A drawing of a set, like figures 3.5 - 3.7 of Yu 2012: the cells of all directions over longitude and latitude
/// and on the upper hemisphere, coloured by solid angle (blue: half of the mean, white: the mean, red: one and a
/// half); below, along the equator, the cosine of the angle to the nearest direction.
struct DirectionPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb; ///< row-major, sRGB
};
DirectionPicture draw(DirectionSet const& directions);

} // namespace gi
