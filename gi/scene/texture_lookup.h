#pragma once
// Texture lookup: bilinear or nearest, without mip maps. The only place where sRGB is decoded.

#include "gi/scene/texture.h"

namespace gi {

/// Where a lookup of one axis falls: the two texels and the weight of the second.
struct TexelPair {
    std::uint32_t first, second;
    float weight;
};

/// Any finite or non-finite integer-valued x becomes a texel of 0..size-1.
GI_FN inline std::uint32_t wrap_texel(float x, std::uint32_t size, Wrap wrap)
{
    float const n = float(size);
    if (wrap == Wrap::repeat) x -= std::floor(x / n) * n;
    if (wrap == Wrap::mirror) {
        x -= std::floor(x / (2 * n)) * 2 * n;
        x = x < n ? x : 2 * n - 1 - x;
    }
    if (!(x > 0)) return 0; // also NaN
    return x < n ? std::uint32_t(x) : size - 1;
}

/// @param coordinate texture coordinate of this axis, 1 = the whole image
GI_FN inline TexelPair texel_pair(float coordinate, std::uint32_t size, Wrap wrap, bool nearest)
{
    float const x = coordinate * float(size);
    if (nearest) {
        std::uint32_t const i = wrap_texel(std::floor(x), size, wrap);
        return {i, i, 0};
    }
    float const low = std::floor(x - 0.5f);
    float const weight = x - 0.5f - low;
    return {wrap_texel(low, size, wrap), wrap_texel(low + 1, size, wrap),
            weight >= 0 && weight <= 1 ? weight : 0.0f};
}

/// Linear RGBA at uv.
GI_FN inline vec4 look_up(TexturePoolView const& pool, Texture const& t, vec2 uv)
{
    TexelPair const u = texel_pair(uv.x, t.width, t.wrap_u, t.nearest);
    TexelPair const v = texel_pair(uv.y, t.height, t.wrap_v, t.nearest);
    auto const texel = [&](std::uint32_t x, std::uint32_t y) {
        Rgba8 const c = pool.texels[t.first + std::uint64_t(y) * t.width + x];
        constexpr float k = 1.0f / 255;
        if (!t.srgb) return vec4{float(c.r), float(c.g), float(c.b), float(c.a)} * k;
        return vec4{pool.linear_of_srgb[c.r], pool.linear_of_srgb[c.g], pool.linear_of_srgb[c.b], float(c.a) * k};
    };
    if (t.nearest) return texel(u.first, v.first);
    vec4 const top = glm::mix(texel(u.first, v.first), texel(u.second, v.first), u.weight);
    vec4 const bottom = glm::mix(texel(u.first, v.second), texel(u.second, v.second), u.weight);
    return glm::mix(top, bottom, v.weight);
}

/// Through a material's reference: chooses the set of coordinates and applies KHR_texture_transform.
GI_FN inline vec4 look_up(TexturePoolView const& pool, TextureRef const& ref, vec2 uv0, vec2 uv1)
{
    vec2 const uv = ref.uv_set == 0 ? uv0 : uv1;
    return look_up(pool, pool.textures[std::size_t(ref.texture)],
                   vec2{glm::dot(ref.row_u, uv), glm::dot(ref.row_v, uv)} + ref.offset);
}

} // namespace gi
