#pragma once
// Small tileable pictures, the same on every machine.

#include "gi/scene/model/texture.h"

#include <functional>

namespace gi {

/// Smooth noise in [0, 1] over the unit square, repeating; `cells` periods across, several octaves.
float tileable_noise(vec2 uv, int cells, std::uint32_t seed);
/// size x size texels. @param color called with uv in [0, 1); linear RGB and alpha. @param srgb stored encoded
std::int32_t add_procedural_texture(TexturePool& pool, int size, bool srgb,
                                    std::function<vec4(vec2 uv)> const& color);

} // namespace gi
