#include "tests/study_display/luminance_of.h"
#include "tests/viewer_gl/stereo_check.h"
#include "tests/viewer_gl/surfaceless.h"

#include <chrono>
#include <epoxy/gl.h>

namespace viewer::test {
namespace {

using Display = Surfaceless;
using Bytes = std::vector<unsigned char>;

/// Radiances from 1e-6 to 1e7 in fine steps, with 0, negatives, infinity and NaN.
gi::Layer ramp(glm::ivec2 size)
{
    gi::Layer layer{"color", 3, {}};
    std::size_t const n = 3 * std::size_t(size.x * size.y);
    for (std::size_t i = 0; i < n; ++i) layer.data.push_back(std::pow(10.0f, -6 + 13 * float(i) / float(n)));
    layer.data[0] = 0;
    layer.data[4] = -3;
    layer.data[8] = std::numeric_limits<float>::infinity();
    layer.data[9] = -std::numeric_limits<float>::infinity();
    layer.data[10] = std::numeric_limits<float>::quiet_NaN();
    return layer;
}

TEST_F(Display, ToneCurvesAreThoseOfTheCpu)
{
    glm::ivec2 const size{640, 200};
    gi::Layer const layer = ramp(size);
    PictureTexture texture;
    texture.upload(size, layer.data);
    DisplayPass pass;
    TextureTarget const target(TextureTarget::Format::bytes, size);
    for (gi::ToneCurve const curve : {gi::ToneCurve::srgb, gi::ToneCurve::filmic})
        for (float const ev : {0.0f, -3.5f, 2.25f}) {
            DisplaySettings settings;
            settings.tone = {ev, curve};
            pass.draw(target.target(), {texture.shown(), {}}, {}, settings);
            Bytes const seen = read_bytes(target.target()), expected = gi::tone_map_bytes(layer, settings.tone);
            EXPECT_LE(largest_difference(seen, expected), 1);
            std::size_t differing = 0;
            for (std::size_t i = 0; i < seen.size(); ++i) differing += seen[i] != expected[i];
            EXPECT_LT(double(differing), 0.01 * double(seen.size()));
            std::cout << "curve " << int(curve) << ", " << ev << " EV: " << differing << " of " << seen.size()
                      << " bytes differ, by at most " << largest_difference(seen, expected) << "\n";
        }
}

/// A display whose channels have different curves: the luminance shown is that of the radiance.
TEST_F(Display, CalibratedPicturesAreThoseOfTheCpuAndLinearInLuminance)
{
    glm::ivec2 const size{640, 200};
    gi::Layer layer = ramp(size);
    PictureTexture texture;
    texture.upload(size, layer.data);
    study::DisplayLuminance display;
    display.black = 0.4;
    display.channels = {study::ChannelCurve{20, 1.9, 1.05, {}, 0, 0, 0},
                        study::ChannelCurve{70, 2.2, 1, {}, 0, 0, 0},
                        study::ChannelCurve{9, 2.5, 0.98, {}, 0, 0, 0}};
    DisplaySettings settings;
    settings.light = display_light(display, make_inverse_table(display), 80);
    DisplayPass pass;
    TextureTarget const target(TextureTarget::Format::bytes, size);
    pass.draw(target.target(), {texture.shown(), {}}, {}, settings);
    Bytes const seen = read_bytes(target.target());
    std::size_t differing = 0;
    int largest = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        int const expected =
            int(std::lround(255 * encode(settings.light, int(i % 3), layer.data[i], settings.tone)));
        largest = std::max(largest, std::abs(int(seen[i]) - expected));
        differing += seen[i] != expected;
    }
    std::cout << differing << " of " << seen.size() << " bytes differ, by at most " << largest << "\n";
    EXPECT_LE(largest, 1);
    EXPECT_LT(double(differing), 0.01 * double(seen.size()));

    // Greys of known luminance: within half a step of 8 bits.
    double worst = 0;
    for (int i = 1; i <= 100; ++i) {
        double const wanted = 0.8 * i; // cd/m2
        std::array<double, 3> values{};
        for (int c = 0; c < 3; ++c)
            values[std::size_t(c)] = encode(settings.light, c, float(i) / 100, settings.tone);
        worst = std::max(worst, std::abs(luminance_of(display, values) - wanted));
    }
    std::cout << "greys of 0.8 to 80 cd/m2: off by at most " << worst << " cd/m2\n";
    EXPECT_LT(worst, 0.5);

    gi::Layer const few{"color", 3, {0.5f, 0.5f, 0.5f, 2, 2, 2, 1e-4f, 1e-4f, 1e-4f, 0, 0, 0}};
    ShownLight const shown = shown_light(few, settings.tone, settings.light, display);
    EXPECT_EQ(shown.pixels, 4u);
    EXPECT_EQ(shown.bright, 1u) << "160 cd/m2";
    EXPECT_EQ(shown.dark, 1u) << "0.008 cd/m2 beside a black of 0.4";
    EXPECT_NEAR(shown.peak_cd_m2, 99.4, 1e-3);
    EXPECT_NEAR(shown.mean_cd_m2, (40 + 99.4 + 0.4 + 0.4) / 4, 1e-3);
    EXPECT_NEAR(mean_and_peak(few, settings.tone, display).second, 2, 1e-6);
}

TEST_F(Display, StereoModesAreThoseOfTheCpu)
{
    for (glm::ivec2 const size : {glm::ivec2{320, 240}, {161, 91}}) {
        TextureTarget const target(TextureTarget::Format::bytes, size);
        check_all_modes(target.target(), {0, 0}, "surfaceless_" + std::to_string(size.x));
        check_all_modes(target.target(), {3, 6}, "surfaceless_odd_" + std::to_string(size.x));
    }
}

TEST_F(Display, PartOfATargetLeavesTheRestAlone)
{
    TextureTarget const whole(TextureTarget::Format::bytes, {64, 48});
    bind(whole.target());
    glClearColor(0, 0, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    DrawTarget const part = part_of(whole.target(), {10, 5}, {20, 30});
    check_all_modes(part, {10, 5}, "part");
    Bytes const bytes = read_bytes(whole.target());
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            bool const inside = x >= 10 && x < 30 && y >= 5 && y < 35;
            bool const blue =
                bytes[std::size_t(3 * (y * 64 + x))] == 0 && bytes[std::size_t(3 * (y * 64 + x) + 2)] == 255;
            EXPECT_NE(inside, blue) << x << ", " << y;
        }
}

TEST_F(Display, QuadBuffersGetTheirEyes)
{
    glm::ivec2 const size{32, 24};
    TextureTarget const a(TextureTarget::Format::bytes, size), b(TextureTarget::Format::bytes, size);
    GlObject const both(GlObject::Kind::framebuffer);
    glNamedFramebufferTexture(both.id(), GL_COLOR_ATTACHMENT0, a.shown().texture, 0);
    glNamedFramebufferTexture(both.id(), GL_COLOR_ATTACHMENT1, b.shown().texture, 0);
    DrawTarget target = a.target();
    target.framebuffer = both.id();
    DisplayPass pass;
    Eyes const eyes(size, 4.0 / 3);
    DisplaySettings settings;
    settings.stereo = StereoMode::quad_buffer;
    EXPECT_EQ(mode_on(target, settings.stereo), StereoMode::side_by_side);
    EXPECT_THROW(pass.draw(target, {eyes.left.shown(), {}}, {eyes.right.shown(), {}}, settings), gi::InputError);
    target.left_buffer = GL_COLOR_ATTACHMENT0;
    target.right_buffer = GL_COLOR_ATTACHMENT1;
    EXPECT_EQ(mode_on(target, settings.stereo), StereoMode::quad_buffer);
    pass.draw(target, {eyes.left.shown(), {}}, {eyes.right.shown(), {}}, settings);
    EXPECT_EQ(read_bytes(target, target.left_buffer), eye_bytes(pass, eyes.left, settings));
    EXPECT_EQ(read_bytes(target, target.right_buffer), eye_bytes(pass, eyes.right, settings));
    EXPECT_NE(read_bytes(target, target.left_buffer), read_bytes(target, target.right_buffer));
}

TEST_F(Display, ComparesTwoPictures)
{
    glm::ivec2 const size{40, 20};
    Eyes const two(size, 2); // any two pictures
    DisplayPass pass;
    DisplaySettings settings;
    Bytes const a = eye_bytes(pass, two.left, settings), b = eye_bytes(pass, two.right, settings);
    TextureTarget const target(TextureTarget::Format::bytes, size);
    auto const shown = [&](Comparison comparison) {
        settings.comparison = comparison;
        pass.draw(target.target(), {two.left.shown(), two.right.shown()}, {}, settings);
        return read_bytes(target.target());
    };
    EXPECT_EQ(shown(Comparison::off), a);
    EXPECT_EQ(shown(Comparison::other), b);
    settings.split = 0.3f;
    Bytes const split = shown(Comparison::split);
    settings.difference_gain = 3;
    Bytes const difference = shown(Comparison::difference);
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t const x = i / 3 % 40;
        EXPECT_EQ(split[i], x < 12 ? a[i] : b[i]) << i;
        EXPECT_EQ(int(difference[i]), std::min(255, 3 * std::abs(int(a[i]) - int(b[i])))) << i;
    }
    settings.comparison = Comparison::difference;
    EXPECT_THROW(pass.draw(target.target(), {two.left.shown(), {}}, {}, settings), gi::InputError);
}

TEST_F(Display, StretchesBilinearly)
{
    PictureTexture texture;
    texture.upload({2, 1}, std::vector<float>{0, 0, 0, 1, 0.5f, 0.25f});
    DisplayPass pass;
    TextureTarget const target(TextureTarget::Format::bytes, {8, 3});
    pass.draw(target.target(), {texture.shown(), {}}, {}, {});
    Bytes const seen = read_bytes(target.target());
    for (int x = 0; x < 8; ++x) {
        float const f = glm::clamp((float(x) + 0.5f) / 4 - 0.5f, 0.0f, 1.0f);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(seen[std::size_t(3 * (8 + x) + c)], 255 * gi::encode_srgb(f / float(1 << c)), 1);
    }
}

TEST_F(Display, EmptyTargetsAreLeftAlone)
{
    Eyes const eyes({4, 4}, 1); // of a window that was made very small
    DisplayPass pass;
    TextureTarget const whole(TextureTarget::Format::bytes, {4, 4});
    for (glm::ivec2 const size : {glm::ivec2{0, 0}, {1, 1}, {0, 3}})
        for (StereoMode const mode : {StereoMode::off, StereoMode::side_by_side, StereoMode::top_bottom}) {
            DisplaySettings settings;
            settings.stereo = mode;
            DrawTarget const target = part_of(whole.target(), {1, 1}, size);
            pass.draw(target, {eyes.left.shown(), {}}, {eyes.right.shown(), {}}, settings);
            EXPECT_EQ(read_bytes(target).size(), std::size_t(3 * size.x * size.y));
        }
}

TEST_F(Display, EncodedValuesPassThrough)
{
    glm::ivec2 const size{30, 20};
    Eyes const eyes(size, 1.5);
    DisplayPass pass;
    TextureTarget const first(TextureTarget::Format::bytes, size), second(TextureTarget::Format::bytes, size);
    DisplaySettings settings;
    settings.tone.exposure_ev = 1;
    pass.draw(first.target(), {eyes.left.shown(), {}}, {}, settings);
    settings.values = PictureValues::encoded;
    pass.draw(second.target(), {first.shown(), {}}, {}, settings);
    EXPECT_EQ(read_bytes(first.target()), read_bytes(second.target()));
}

TEST_F(Display, RefusesPicturesWithoutTheirValues)
{
    PictureTexture texture;
    std::vector<float> const values(12);
    EXPECT_THROW(texture.upload({2, 3}, values), gi::InputError);
    EXPECT_THROW(texture.upload({2, 2}, values, std::vector<float>(3)), gi::InputError);
    EXPECT_THROW(texture.upload({0, 2}, {}), gi::InputError);
    DisplayPass pass;
    TextureTarget const target(TextureTarget::Format::bytes, {4, 4});
    EXPECT_THROW(pass.draw(target.target(), {}, {}, {}), gi::InputError);
}

TEST_F(Display, TimesAreStated)
{
    glm::ivec2 const size{640, 480};
    RoomPicture const picture = room_seen_by(room_eye(0, 4.0 / 3), size);
    PictureTexture texture;
    DisplayPass pass;
    TextureTarget const target(TextureTarget::Format::bytes, size);
    auto const ms_of = [](auto const& work) {
        double best = 1e9;
        for (int i = 0; i < 5; ++i) {
            auto const start = std::chrono::steady_clock::now();
            work();
            glFinish();
            best = std::min(
                best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        }
        return best;
    };
    double const upload = ms_of([&] { texture.upload(size, picture.rgb, picture.depth_m); });
    std::cout << gl->description() << ", 640x480, least of 5: upload " << upload << " ms";
    for (StereoMode const mode : {StereoMode::off, StereoMode::rows, StereoMode::anaglyph_dubois}) {
        DisplaySettings settings;
        settings.stereo = mode;
        double const draw = ms_of([&] {
            pass.draw(target.target(), {texture.shown(), {}}, {texture.shown(), {}}, settings);
        });
        std::cout << ", " << name_of(mode) << " " << draw << " ms";
        EXPECT_LT(draw, 1000);
    }
    std::cout << "\n";
}

/// Compiled shaders take memory, and a session may use all modes.
TEST_F(Display, KeepsAFewPrograms)
{
    glm::ivec2 const size{16, 8};
    std::vector<float> const grey(std::size_t(3 * size.x * size.y), 0.5f);
    PictureTexture texture;
    texture.upload(size, grey);
    EyeView const eye{texture.shown(), texture.shown()};
    DisplayPass pass;
    TextureTarget const target(TextureTarget::Format::bytes, size);
    DisplaySettings settings;
    pass.draw(target.target(), eye, eye, settings);
    Bytes const first = read_bytes(target.target());
    auto const programs = [] {
        std::size_t count = 0;
        for (GLuint name = 1; name < 10000; ++name) count += glIsProgram(name) == GL_TRUE ? 1 : 0;
        return count;
    };
    std::size_t drawn = 1;
    for (StereoMode const mode : {StereoMode::side_by_side, StereoMode::rows})
        for (Comparison const comparison :
             {Comparison::off, Comparison::split, Comparison::other, Comparison::difference})
            for (gi::ToneCurve const curve : {gi::ToneCurve::srgb, gi::ToneCurve::filmic}) {
                settings.stereo = mode;
                settings.comparison = comparison;
                settings.tone.curve = curve;
                pass.draw(target.target(), eye, eye, settings);
                EXPECT_EQ(programs(), std::min(++drawn, DisplayPass::kPrograms));
            }
    pass.draw(target.target(), eye, eye, {});
    EXPECT_EQ(read_bytes(target.target()), first);
}

} // namespace
} // namespace viewer::test
