#pragma once
// The transfer curve of sRGB (IEC 61966-2-1).

#include <cmath>

namespace gi {

/// Linear light, 0..1, of a value as monitors show it. @tparam T float or double
template <class T>
T decode_srgb(T v)
{
    return v <= T(0.04045) ? v / T(12.92) : std::pow((v + T(0.055)) / T(1.055), T(2.4));
}

} // namespace gi
