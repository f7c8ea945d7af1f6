// The pass into the runtime's images, where a context without a window can be had.

#include "tests/viewer_gl/surfaceless.h"
#include "viewer/devices/xr/eye_pass.h"

#include <epoxy/gl.h>

namespace viewer::test {
namespace {

using Pixel = std::array<std::uint8_t, 4>;

class EyePassTest : public Surfaceless {
protected:
    unsigned texture(GLenum format, int width, int height, std::vector<Pixel> const& pixels)
    {
        unsigned name = 0;
        glCreateTextures(GL_TEXTURE_2D, 1, &name);
        glTextureStorage2D(name, 1, format, width, height);
        if (!pixels.empty())
            glTextureSubImage2D(name, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        return name;
    }
    /// Bytes as they are stored, first row at the bottom.
    std::vector<Pixel> bytes(EyePass::Target const& target)
    {
        std::vector<Pixel> pixels(std::size_t(target.width) * std::size_t(target.height));
        glGetTextureImage(target.texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(pixels.size() * 4), pixels.data());
        return pixels;
    }
    EyePass::Target target(GLenum format, int width, int height)
    {
        return {texture(format, width, height, {}), 0, width, height, format == GL_SRGB8_ALPHA8};
    }
    static std::vector<Pixel> all_values()
    {
        std::vector<Pixel> pixels;
        for (int i = 0; i < 256; ++i)
            pixels.push_back({std::uint8_t(i), std::uint8_t(255 - i), std::uint8_t(i ^ 85), 255});
        return pixels;
    }
};

TEST_F(EyePassTest, CodeArrivesAsItIs)
{
    EyePass const pass;
    std::vector<Pixel> const pixels = all_values();
    unsigned const from = texture(GL_RGBA8, 16, 16, pixels);
    auto const to = target(GL_SRGB8_ALPHA8, 16, 16);
    pass.draw(from, TextureValues::srgb, FirstRow::bottom, to);
    EXPECT_EQ(bytes(to), pixels);
}

TEST_F(EyePassTest, FirstRowIsTurned)
{
    EyePass const pass;
    unsigned const from = texture(GL_RGBA8, 1, 2, {Pixel{10, 20, 30, 255}, Pixel{40, 50, 60, 255}});
    auto const to = target(GL_SRGB8_ALPHA8, 1, 2);
    pass.draw(from, TextureValues::srgb, FirstRow::top, to);
    EXPECT_EQ(bytes(to), (std::vector<Pixel>{Pixel{40, 50, 60, 255}, Pixel{10, 20, 30, 255}}));
}

TEST_F(EyePassTest, LightIsEncodedAndCodeDecoded)
{
    EyePass const pass;
    std::vector<Pixel> const pixels = all_values();
    // A texture that decodes when read, into one that encodes: within a step of the driver's tables.
    auto const encoded = target(GL_SRGB8_ALPHA8, 16, 16);
    pass.draw(texture(GL_SRGB8_ALPHA8, 16, 16, pixels), TextureValues::linear, FirstRow::bottom, encoded);
    // sRGB code into a linear target.
    auto const decoded = target(GL_RGBA8, 16, 16);
    pass.draw(texture(GL_RGBA8, 16, 16, pixels), TextureValues::srgb, FirstRow::bottom, decoded);
    auto const e = bytes(encoded), d = bytes(decoded);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(e[i][c], pixels[i][c], 1);
            double const s = pixels[i][c] / 255.0;
            double const light = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
            EXPECT_NEAR(d[i][c], 255 * light, 1);
        }
}

TEST_F(EyePassTest, DepthsAreReversedAndTurned)
{
    EyePass const pass;
    unsigned const colors = texture(GL_RGBA8, 1, 3, std::vector<Pixel>(3, Pixel{1, 2, 3, 255}));
    auto const floats = [&](GLenum format, GLenum layout, std::vector<float> const& values) {
        unsigned const made = texture(format, 1, 3, {});
        glTextureSubImage2D(made, 0, 0, 0, 1, 3, layout, GL_FLOAT, values.data());
        return made;
    };
    // Infinitely far, 2 m and 1 cm away: once as 1 / depth in alpha, once as 1 mm / depth.
    ShownDepth const in_alpha{floats(GL_RGBA32F, GL_RGBA, {9, 9, 9, 0, 9, 9, 9, 0.5f, 9, 9, 9, 100}), true, 1};
    ShownDepth const in_red{floats(GL_R32F, GL_RED, {0, 0.0005f, 0.1f}), false, 1000};
    for (GLenum const format : {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT24, GL_DEPTH24_STENCIL8})
        for (ShownDepth const& depth : {in_alpha, in_red}) {
            auto to = target(GL_SRGB8_ALPHA8, 1, 3);
            to.depth_texture = texture(format, 1, 3, {});
            pass.draw(colors, TextureValues::srgb, FirstRow::top, to, depth);
            EXPECT_EQ(bytes(to)[2], (Pixel{1, 2, 3, 255}));
            float drawn[3] = {};
            glGetTextureImage(to.depth_texture, 0, GL_DEPTH_COMPONENT, GL_FLOAT, sizeof drawn, drawn);
            EXPECT_NEAR(drawn[0], 1, 1e-6) << "nearer than what has a depth of 1";
            EXPECT_NEAR(drawn[1], EyePass::kNear_m / 2, 1e-6);
            EXPECT_EQ(drawn[2], 0);
        }
}

TEST_F(EyePassTest, SizesMayDiffer)
{
    EyePass const pass;
    unsigned const from = texture(GL_RGBA8, 2, 1, {Pixel{0, 0, 0, 255}, Pixel{200, 200, 200, 255}});
    auto const to = target(GL_SRGB8_ALPHA8, 8, 4);
    pass.draw(from, TextureValues::srgb, FirstRow::bottom, to);
    auto const pixels = bytes(to);
    EXPECT_EQ(pixels[0][0], 0);
    EXPECT_EQ(pixels[7][0], 200);
    EXPECT_LT(pixels[3][0], pixels[4][0]);
}

TEST_F(EyePassTest, LeavesNothingSwitchedOn)
{
    EyePass const pass;
    unsigned const mine = texture(GL_RGBA8, 1, 1, {Pixel{1, 2, 3, 4}});
    glEnable(GL_BLEND);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, 0, 0);
    glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE);
    auto to = target(GL_SRGB8_ALPHA8, 1, 1);
    to.depth_texture = texture(GL_DEPTH_COMPONENT32F, 1, 1, {});
    for (TextureValues const values : {TextureValues::srgb, TextureValues::linear}) {
        pass.draw(mine, values, FirstRow::top, to, {mine, false, 1});
        for (GLenum const what : {GL_BLEND, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_FRAMEBUFFER_SRGB})
            EXPECT_FALSE(glIsEnabled(what)) << what;
    }
    pass.draw(mine, TextureValues::srgb, FirstRow::top, to);
    EXPECT_EQ(bytes(to)[0], (Pixel{1, 2, 3, 255})) << "opaque, and not blended";
    for (GLuint const unit : {0u, 1u}) {
        GLint sampler = 0;
        glActiveTexture(GL_TEXTURE0 + unit);
        glGetIntegerv(GL_SAMPLER_BINDING, &sampler);
        EXPECT_EQ(sampler, 0);
    }
    GLint depth_test = 0;
    glGetIntegerv(GL_DEPTH_FUNC, &depth_test);
    EXPECT_EQ(depth_test, GL_LESS);
}

} // namespace
} // namespace viewer::test
