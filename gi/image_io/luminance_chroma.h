#pragma once
// Luminance with chroma of a quarter of the samples, OpenEXR's compressed colours.

#include "gi/core/math.h"

#include <vector>

namespace gi {

/// A channel over a window: values every step_x-th pixel of every step_y-th row, from the first on.
struct SparsePlane {
    int step_x = 1, step_y = 1; ///< 1 or 2
    std::vector<float> values;  ///< row-major, ceil(width / step_x) x ceil(height / step_y)
};

/// The values between the samples, by OpenEXR's filter (ImfRgbaYca.cpp); beyond the window those at its border.
std::vector<float> spread(SparsePlane const& plane, int width, int height);

/// RGB of luminance Y and chroma RY = (R - Y) / Y, BY = (B - Y) / Y (ImfRgbaYca.h).
/// @param weights  of red, green, blue in Y
inline vec3 rgb_of(float y, float ry, float by, dvec3 weights)
{
    double const r = (double(ry) + 1) * double(y), b = (double(by) + 1) * double(y);
    return {float(r), float((double(y) - r * weights.x - b * weights.z) / weights.y), float(b)};
}

} // namespace gi
