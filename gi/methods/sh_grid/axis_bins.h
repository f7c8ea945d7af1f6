#pragma once
// Quantities of surfaces by the six directions along the axes of a grid: -x, +x, -y, +y, -z, +z.

#include "gi/core/math.h"

namespace gi {

template <class T>
struct AxisBins {
    T bin[6] = {};

    GI_FN AxisBins& operator+=(AxisBins const& o)
    {
        for (int k = 0; k < 6; ++k) bin[k] += o.bin[k];
        return *this;
    }
    GI_FN T largest() const
    {
        T most = bin[0];
        for (int k = 1; k < 6; ++k) most = bin[k] > most ? bin[k] : most;
        return most;
    }
    /// Divides a value among the three bins that a direction points to, by the squares of its components.
    /// @param direction  unit
    GI_FN void add(vec3 direction, T const& value)
    {
        for (int axis = 0; axis < 3; ++axis)
            bin[2 * axis + (direction[axis] > 0 ? 1 : 0)] += square(direction[axis]) * value;
    }
};

/// The bin that a direction points to most.
GI_FN inline std::uint32_t main_axis(vec3 d)
{
    vec3 const a = glm::abs(d);
    int const axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return std::uint32_t(2 * axis + (d[axis] > 0 ? 1 : 0));
}

} // namespace gi
