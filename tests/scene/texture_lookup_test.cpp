// Textures: decoding, interpolation, wrapping, transforms.

#include "gi/scene/shading/texture_lookup.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace gi::test {
namespace {

/// A pool with one texture whose red is 0, 1, 2, ... in steps of `step`.
TexturePool counting(std::uint32_t width, std::uint32_t height, int step, Wrap wrap, bool nearest = false)
{
    TexturePool pool;
    pool.texels.push_back({255, 0, 255, 255}); // of another texture, that must not be seen
    Texture t;
    t.first = 1;
    t.width = width;
    t.height = height;
    t.wrap_u = t.wrap_v = wrap;
    t.nearest = nearest;
    for (std::uint32_t i = 0; i < width * height; ++i)
        pool.texels.push_back({std::uint8_t(int(i) * step), 7, 0, std::uint8_t(255 - i)});
    pool.texels.push_back({255, 0, 255, 255});
    pool.textures.push_back(t);
    return pool;
}

float red(TexturePool const& pool, vec2 uv) { return look_up(view(pool), pool.textures[0], uv).x * 255; }

TEST(TextureLookup, SrgbIsDecodedByItsFormula)
{
    TexturePool pool = counting(16, 16, 1, Wrap::clamp);
    pool.textures[0].srgb = true;
    for (int i = 0; i < 256; ++i) {
        vec4 const c = look_up(view(pool), pool.textures[0], (vec2{float(i % 16), float(i / 16)} + 0.5f) / 16.0f);
        double const s = i / 255.0, linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(c.x, linear, 1e-6) << i;
        EXPECT_NEAR(c.w, (255 - i) / 255.0, 1e-6) << "alpha is never encoded, " << i;
    }
    pool.textures[0].srgb = false;
    EXPECT_NEAR(red(pool, {0.5f / 16, 8.5f / 16}), 128, 1e-3);
}

TEST(TextureLookup, TexelCentresAreExactAndBetweenThemItIsLinear)
{
    TexturePool const pool = counting(4, 3, 20, Wrap::clamp);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            EXPECT_NEAR(red(pool, {(float(x) + 0.5f) / 4, (float(y) + 0.5f) / 3}), 20 * (4 * y + x), 1e-3);
    EXPECT_NEAR(red(pool, {0.25f, 0.5f / 3}), 10, 1e-3);
    EXPECT_NEAR(red(pool, {0.5f / 4, 1.0f / 3}), 40, 1e-3);
    EXPECT_NEAR(red(pool, {1.75f / 4, 0.75f / 3}), 20 * (1.25 + 4 * 0.25), 1e-3);
}

TEST(TextureLookup, CornersWrapAsAsked)
{
    // Texels 0 20 40 60; u = 0 is half-way between the last and the first.
    EXPECT_NEAR(red(counting(4, 1, 20, Wrap::repeat), {0, 0}), 30, 1e-3);
    EXPECT_NEAR(red(counting(4, 1, 20, Wrap::clamp), {0, 0}), 0, 1e-3);
    EXPECT_NEAR(red(counting(4, 1, 20, Wrap::mirror), {0, 0}), 0, 1e-3);
    EXPECT_NEAR(red(counting(4, 1, 20, Wrap::repeat), {1, 0}), 30, 1e-3);
    EXPECT_NEAR(red(counting(4, 1, 20, Wrap::clamp), {1, 0}), 60, 1e-3);
    EXPECT_NEAR(red(counting(4, 1, 20, Wrap::mirror), {1, 0}), 60, 1e-3);
}

TEST(TextureLookup, CoordinatesFarOutsideWrapToo)
{
    for (int turn : {-1000, -3, -2, -1, 0, 1, 2, 5, 1000})
        for (int x = 0; x < 5; ++x)
            for (bool const nearest : {false, true}) {
                vec2 const uv{float(turn) + (float(x) + 0.5f) / 5, 0.5f};
                EXPECT_NEAR(red(counting(5, 1, 20, Wrap::repeat, nearest), uv), 20 * x, 0.1) << uv.x;
                int const clamped = turn < 0 ? 0 : turn > 0 ? 4 : x;
                EXPECT_NEAR(red(counting(5, 1, 20, Wrap::clamp, nearest), uv), 20 * clamped, 0.1) << uv.x;
                int const mirrored = turn % 2 == 0 ? x : 4 - x;
                EXPECT_NEAR(red(counting(5, 1, 20, Wrap::mirror, nearest), uv), 20 * mirrored, 0.1) << uv.x;
            }
}

TEST(TextureLookup, NearestTakesTheTexelThatHoldsThePoint)
{
    TexturePool const pool = counting(4, 2, 20, Wrap::repeat, true);
    EXPECT_NEAR(red(pool, {0.0f, 0.0f}), 0, 1e-3);
    EXPECT_NEAR(red(pool, {0.249f, 0.49f}), 0, 1e-3);
    EXPECT_NEAR(red(pool, {0.251f, 0.51f}), 100, 1e-3);
    EXPECT_NEAR(red(pool, {-0.01f, 0.0f}), 60, 1e-3);
    EXPECT_NEAR(red(pool, {0.999f, 0.999f}), 140, 1e-3);
}

TEST(TextureLookup, NoCoordinateLeavesTheTexture)
{
    float const inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> const odd{nan,    inf,    -inf,    3e38f,       -3e38f, 1e30f,       -1e30f, 1e10f,
                                 -1e10f, 1e-40f, -1e-40f, 16777217.0f, -0.0f,  0.99999994f, -1e-9f};
    for (Wrap const wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        for (bool const nearest : {false, true})
            for (std::uint32_t const size : {1u, 2u, 3u, 7u}) {
                TexturePool const pool = counting(size, size, 1, wrap, nearest);
                for (float const u : odd)
                    for (float const v : odd) {
                        vec4 const c = look_up(view(pool), pool.textures[0], {u, v});
                        ASSERT_TRUE(c.x >= 0 && c.x <= float(size * size - 1) / 255 + 1e-6f) << u << " " << v;
                        ASSERT_NEAR(c.y, 7 / 255.0, 1e-6) << "a texel of another texture: " << u << " " << v;
                    }
            }
}

/// KHR_texture_transform: uv' = T R S uv, where R turns counter-clockwise as one sees the image (v points down).
TEST(TextureLookup, ReferencesTransformTheirCoordinates)
{
    TexturePool const pool = counting(8, 8, 3, Wrap::repeat);
    float const angle = 0.7f, c = std::cos(angle), s = std::sin(angle);
    vec2 const scale{0.5f, 2}, offset{0.1f, -0.3f};
    TextureRef ref;
    ref.texture = 0;
    ref.uv_set = 1;
    ref.row_u = {c * scale.x, s * scale.y};
    ref.row_v = {-s * scale.x, c * scale.y};
    ref.offset = offset;
    for (vec2 const uv : {vec2{0, 0}, vec2{0.3f, 0.8f}, vec2{-1.2f, 2.7f}}) {
        vec2 const scaled = scale * uv;
        vec2 const expected = vec2{c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y} + offset;
        EXPECT_NEAR(look_up(view(pool), ref, vec2{77, 77}, uv).x * 255, red(pool, expected), 1e-2);
    }
    ref.uv_set = 0;
    EXPECT_NEAR(look_up(view(pool), ref, vec2{0, 0}, vec2{77, 77}).x * 255, red(pool, offset), 1e-3);
}

} // namespace
} // namespace gi::test
