#pragma once
// Textures. All texels of a scene are stored in one pool, so that kernels need only one pointer.

#include "gi/core/math.h"
#include "gi/core/view.h"

#include <cstdint>
#include <vector>

namespace gi {

struct alignas(4) Rgba8 { // so that kernels load it as one word
    std::uint8_t r, g, b, a;
};

enum class Wrap : std::uint8_t { repeat, clamp, mirror };

/// One image in the pool, row-major with the top row first: texel (x, y) is pool[first + y * width + x].
/// (u, v) = (0, 0) is the corner of the first texel (glTF convention).
struct Texture {
    std::uint64_t first = 0;
    std::uint32_t width = 0, height = 0;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false; ///< bilinear otherwise
    bool srgb = false;    ///< r, g, b (not a) are sRGB-encoded: base colour, emissive, specular colour
};

/// Reference of a material to a texture, with KHR_texture_transform: uv' = T * R * S * uv.
struct TextureRef {
    std::int32_t texture = -1;                   ///< index into TexturePool::textures, -1 = none
    std::uint8_t uv_set = 0;                     ///< 0 or 1
    vec2 row_u{1, 0}, row_v{0, 1}, offset{0, 0}; ///< u' = dot(row_u, uv) + offset.x, v' likewise

    bool operator==(TextureRef const&) const = default;
};

struct TexturePool {
    std::vector<Rgba8> texels;
    std::vector<Texture> textures;
};

struct TexturePoolView {
    View<Rgba8 const> texels;
    View<Texture const> textures;
    View<float const> linear_of_srgb; ///< 256 entries
};

/// Table of the sRGB decoding (IEC 61966-2-1) of 0..255, in static storage.
View<float const> linear_of_srgb();

inline TexturePoolView view(TexturePool const& pool) { return {pool.texels, pool.textures, linear_of_srgb()}; }

} // namespace gi
