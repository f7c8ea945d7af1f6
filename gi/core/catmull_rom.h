#pragma once
#include <array>

namespace gi {

/// Weights of four successive values for cubic interpolation between the middle two (Catmull and Rom 1974).
/// @param t  position between them, 0..1
inline std::array<float, 4> catmull_rom(float t)
{
    return {t * (-0.5f + t * (1 - 0.5f * t)), 1 + t * t * (-2.5f + 1.5f * t), t * (0.5f + t * (2 - 1.5f * t)),
            t * t * (-0.5f + 0.5f * t)};
}

} // namespace gi
