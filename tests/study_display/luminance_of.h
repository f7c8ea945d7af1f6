#pragma once
#include "study/display/display_model.h"

namespace study {

/// Luminance of a colour of three digital values in [0, 1], cd/m2.
inline double luminance_of(DisplayLuminance const& light, std::array<double, 3> const& values)
{
    double sum = light.black;
    for (int c = 0; c < 3; ++c)
        sum += light.channels[std::size_t(c)].peak * share_of_value(light, c, values[std::size_t(c)]);
    return sum;
}

} // namespace study
