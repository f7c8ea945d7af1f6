#pragma once
// Texture lookup: bilinear or nearest, without mip maps. The only place where sRGB is decoded.

#include "gi/scene/model/texture.h"

namespace gi {

/// The two texels that a lookup interpolates along one axis, and the weight of the second.
struct TexelPair {
    std::uint32_t first, second;
    float weight;
};

/// Maps a coordinate into [0, 1] by the wrap mode; 0 if not finite.
GI_FN inline float wrap_coordinate(float x, Wrap wrap)
{
    if (wrap == Wrap::repeat) x -= std::floor(x);
    if (wrap == Wrap::mirror) {
        x -= 2 * std::floor(0.5f * x);
        x = x > 1 ? 2 - x : x;
    }
    if (!(x >= 0)) return 0; // also NaN
    return x < 1 ? x : 1.0f;
}

/// @param coordinate texture coordinate of this axis, 1 = the whole image
GI_FN inline TexelPair texel_pair(float coordinate, std::uint32_t size, Wrap wrap, bool nearest)
{
    float const x = wrap_coordinate(coordinate, wrap) * float(size);
    int const last = int(size) - 1;
    if (nearest) {
        auto const i = std::uint32_t(glm::min(int(x), last));
        return {i, i, 0};
    }
    float const low = std::floor(x - 0.5f);
    int const i = int(low); // -1 .. last
    bool const around = wrap == Wrap::repeat;
    int const first = i >= 0 ? glm::min(i, last) : around ? last : 0;
    int const second = i < last ? i + 1 : around ? 0 : last;
    return {std::uint32_t(first), std::uint32_t(second), x - 0.5f - low};
}

/// Linear RGBA at uv.
GI_FN inline vec4 look_up(TexturePoolView const& pool, Texture const& t, vec2 uv)
{
    constexpr float kStep = 1.0f / 255;
    TexelPair const u = texel_pair(uv.x, t.width, t.wrap_u, t.nearest);
    TexelPair const v = texel_pair(uv.y, t.height, t.wrap_v, t.nearest);
    Rgba8 const* const top = &pool.texels[t.first + std::uint64_t(v.first) * t.width];
    Rgba8 const* const bottom = &pool.texels[t.first + std::uint64_t(v.second) * t.width];
    Rgba8 const a = top[u.first], b = top[u.second], c = bottom[u.first], d = bottom[u.second];
    float const wd = u.weight * v.weight, wc = v.weight - wd, wb = u.weight - wd, wa = 1 - u.weight - wc;
    auto const mix = [&](auto const& value) {
        return wa * value(a) + wb * value(b) + wc * value(c) + wd * value(d);
    };
    float const alpha = mix([](Rgba8 x) { return float(x.a); }) * kStep;
    if (!t.srgb)
        return {mix([](Rgba8 x) { return float(x.r); }) * kStep, mix([](Rgba8 x) { return float(x.g); }) * kStep,
                mix([](Rgba8 x) { return float(x.b); }) * kStep, alpha};
    float const* const linear = pool.linear_of_srgb.data;
    return {mix([linear](Rgba8 x) { return linear[x.r]; }), mix([linear](Rgba8 x) { return linear[x.g]; }),
            mix([linear](Rgba8 x) { return linear[x.b]; }), alpha};
}

/// Selects the UV set and applies KHR_texture_transform.
GI_FN inline vec2 transform_uv(TextureRef const& ref, vec2 uv0, vec2 uv1)
{
    vec2 const uv = ref.uv_set == 0 ? uv0 : uv1;
    return vec2{glm::dot(ref.row_u, uv), glm::dot(ref.row_v, uv)} + ref.offset;
}

/// Linear RGBA through a material's texture reference.
GI_FN inline vec4 look_up(TexturePoolView const& pool, TextureRef const& ref, vec2 uv0, vec2 uv1)
{
    return look_up(pool, pool.textures[std::size_t(ref.texture)], transform_uv(ref, uv0, uv1));
}

} // namespace gi
