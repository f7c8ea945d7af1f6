#pragma once
// Small tileable textures, identical on every machine.

#include "gi/scene/model/texture.h"

#include <functional>

namespace gi {

/// Returns smooth, tileable noise in [0, 1] over the unit square, with `cells` periods across and several octaves.
float tileable_noise(vec2 uv, int cells, std::uint32_t seed);
/// Adds a texture of size x size texels.
/// @param color called with uv in [0, 1)^2; returns linear RGB and alpha   @param srgb store sRGB-encoded
std::int32_t add_procedural_texture(TexturePool& pool, int size, bool srgb,
                                    std::function<vec4(vec2 uv)> const& color);

} // namespace gi
