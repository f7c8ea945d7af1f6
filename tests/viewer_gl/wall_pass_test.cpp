#include "tests/viewer_gl/stereo_check.h"
#include "tests/viewer_gl/surfaceless.h"
#include "viewer/devices/gl/wall_pass.h"
#include "viewer/displays/compose.h"

#include <epoxy/gl.h>

namespace viewer::test {
namespace {

using Wall = Surfaceless;
using Bytes = std::vector<unsigned char>;
using Format = TextureTarget::Format;

constexpr glm::ivec2 kWallSize{64, 48};

float side(float at, float width, float power)
{
    if (width <= 0 || at >= width) return 1;
    float const t = std::max(at / width, 0.0f);
    return t < 0.5f ? 0.5f * std::pow(2 * t, power) : 1 - 0.5f * std::pow(2 * (1 - t), power);
}

/// Weight of light of the formula of EdgeBlend at a place of the picture, 0..1 from the lower left.
float blend_weight(EdgeBlend const& b, glm::vec2 at)
{
    return side(at.x, b.left, b.power) * side(1 - at.x, b.right, b.power) * side(at.y, b.bottom, b.power) *
           side(1 - at.y, b.top, b.power);
}

/// An encoded picture of the room.
struct Shown {
    TextureTarget target{Format::bytes, kWallSize};
    Bytes bytes;

    Shown()
    {
        Eyes const eyes(kWallSize, 4.0 / 3);
        DisplayPass pass;
        pass.draw(target.target(), {eyes.left.shown(), {}}, {}, {});
        bytes = read_bytes(target.target());
    }
};

Bytes walled(WallSettings const& settings, ShownPicture const& picture, glm::ivec2 size = kWallSize)
{
    WallPass const pass(settings);
    TextureTarget const out(Format::bytes, size);
    pass.draw(out.target(), picture);
    return read_bytes(out.target());
}

ShownPicture white(TextureTarget const& target)
{
    bind(target.target());
    glClearColor(1, 1, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    return target.shown();
}

std::size_t at(int x, int y) { return std::size_t(3 * (y * kWallSize.x + x)); }

TEST_F(Wall, PlainWallChangesNothing)
{
    Shown const shown;
    EXPECT_EQ(walled({}, shown.target.shown()), shown.bytes);
    WallSettings fine; // a fine mesh is the same mesh
    fine.mesh = {9, 7, {}};
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x) {
            glm::vec2 const p(float(x) / 8, float(y) / 6);
            fine.mesh.vertices.push_back({p, p, 1});
        }
    EXPECT_EQ(walled(fine, shown.target.shown()), shown.bytes);
}

TEST_F(Wall, MeshTurnsAndShrinks)
{
    Shown const shown;
    WallSettings turned;
    for (WarpVertex& v : turned.mesh.vertices) v.picture = glm::vec2(1) - v.picture;
    Bytes const upside_down = walled(turned, shown.target.shown());
    for (int y = 0; y < kWallSize.y; ++y)
        for (int x = 0; x < kWallSize.x; ++x)
            EXPECT_EQ(upside_down[at(x, y)], shown.bytes[at(kWallSize.x - 1 - x, kWallSize.y - 1 - y)]);
    WallSettings corner; // into the upper right quarter
    for (WarpVertex& v : corner.mesh.vertices) v.position = glm::vec2(0.5f) + 0.5f * v.position;
    Bytes const small = walled(corner, shown.target.shown());
    for (int y = 0; y < kWallSize.y / 2; ++y)
        for (int x = kWallSize.x / 2; x < kWallSize.x; ++x) {
            int sum = 0; // two pixels to one: in the middle of four
            for (int k = 0; k < 4; ++k) sum += shown.bytes[at(2 * (x - kWallSize.x / 2) + k % 2, 2 * y + k / 2)];
            EXPECT_NEAR(small[at(x, y)], sum / 4.0, 1);
        }
    for (int y = 0; y < kWallSize.y; ++y)
        for (int x = 0; x < kWallSize.x; ++x)
            if (x < kWallSize.x / 2 || y >= kWallSize.y / 2) {
                EXPECT_EQ(int(small[at(x, y)]), 0);
            }
}

TEST_F(Wall, BeyondThePictureItIsBlack)
{
    Shown const shown;
    WallSettings wide;
    for (WarpVertex& v : wide.mesh.vertices) v.picture = 2.0f * v.picture - glm::vec2(0.5f);
    Bytes const bytes = walled(wide, shown.target.shown());
    EXPECT_EQ(int(bytes[at(2, 20)]), 0);
    EXPECT_EQ(int(bytes[at(kWallSize.x - 3, 20)]), 0);
    EXPECT_GT(int(bytes[at(kWallSize.x / 2, 30)]), 0);
}

TEST(EdgeBlendFormula, NeighboursHaveTheSumOne)
{
    for (float const power : {0.7f, 1.0f, 2.0f, 3.5f})
        for (float const width : {0.1f, 0.25f, 0.5f}) {
            EdgeBlend left, right; // the left projector fades on its right side
            left.right = right.left = width;
            left.power = right.power = power;
            for (float t = 0; t <= 1; t += 0.01f) {
                float const sum =
                    blend_weight(left, {1 - width + t * width, 0.5f}) + blend_weight(right, {t * width, 0.5f});
                EXPECT_NEAR(sum, 1, 1e-4); // powers below 1 are steep where floats are rounded
            }
            EXPECT_EQ(blend_weight(left, {0.3f, 0.5f}), 1);
        }
    EdgeBlend corner;
    corner.left = corner.bottom = 0.5f;
    EXPECT_FLOAT_EQ(blend_weight(corner, {0.25f, 0.25f}), 0.25f);
    EXPECT_EQ(blend_weight(corner, {0, 0.7f}), 0);
}

TEST_F(Wall, WeightsAndGainsAreThoseOfLight)
{
    TextureTarget const source(Format::bytes, kWallSize);
    ShownPicture const picture = white(source);
    WallSettings settings;
    settings.blend = {0.25f, 0.1f, 0, 0.5f, 1.5f};
    settings.gain = {1, 0.5f, 0.25f};
    settings.gamma = {2.2f, 1.8f, 1};
    Bytes const seen = walled(settings, picture);
    for (int y = 0; y < kWallSize.y; ++y)
        for (int x = 0; x < kWallSize.x; ++x) {
            glm::vec2 const p((float(x) + 0.5f) / float(kWallSize.x), 1 - (float(y) + 0.5f) / float(kWallSize.y));
            float const weight = blend_weight(settings.blend, p);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(seen[at(x, y) + std::size_t(k)],
                            255 * std::pow(weight * settings.gain[k], 1 / settings.gamma[k]), 0.51)
                    << x << ", " << y;
        }
}

TEST_F(Wall, BlendMapAndVertexWeightsMultiply)
{
    TextureTarget const source(Format::bytes, kWallSize);
    ShownPicture const picture = white(source);
    WallSettings settings;
    settings.gamma = glm::vec3(1);
    PixelMap half{kWallSize.x, kWallSize.y, std::vector<glm::vec3>(64 * 48, glm::vec3(0.5f))};
    half.values[5] = glm::vec3(0); // sixth pixel of the top row
    settings.blend_map = std::make_shared<PixelMap const>(half);
    for (WarpVertex& v : settings.mesh.vertices) v.weight = v.position.y;
    Bytes const seen = walled(settings, picture);
    EXPECT_EQ(int(seen[at(5, 0)]), 0);
    for (int const y : {3, 20, 45}) EXPECT_NEAR(seen[at(9, y)], 255 * 0.5 * (1 - (y + 0.5) / kWallSize.y), 0.51);
}

TEST_F(Wall, MapsOfPositionsAreFollowedPixelByPixel)
{
    Shown const shown;
    WallSettings settings;
    PixelMap turned{kWallSize.x, kWallSize.y, {}}; // by half a turn; positions count from the upper left
    for (int y = 0; y < kWallSize.y; ++y)
        for (int x = 0; x < kWallSize.x; ++x)
            turned.values.push_back(
                {1 - (float(x) + 0.5f) / float(kWallSize.x), 1 - (float(y) + 0.5f) / float(kWallSize.y), 0});
    turned.values[7] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    turned.values[8] = {1.1f, 0.5f, 0};
    settings.positions = std::make_shared<PixelMap const>(turned);
    Bytes const seen = walled(settings, shown.target.shown());
    for (int y = 0; y < kWallSize.y; ++y)
        for (int x = 0; x < kWallSize.x; ++x)
            EXPECT_EQ(int(seen[at(x, y)]), y == 0 && (x == 7 || x == 8)
                                               ? 0
                                               : int(shown.bytes[at(kWallSize.x - 1 - x, kWallSize.y - 1 - y)]));
}

/// out = black + (1 - black) * blend * light, all linear.
TEST_F(Wall, BlackIsRaisedInLinearLight)
{
    TextureTarget const source(Format::bytes, kWallSize);
    bind(source.target());
    glClearColor(0.5f, 0.5f, 0.5f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    auto const map = [](glm::vec3 value) {
        return std::make_shared<PixelMap const>(
            PixelMap{2, 2, {value, 0.5f * value, value, 0.5f * value}}); // darker to the right
    };
    WallSettings settings;
    settings.blend_map = map({1, 0.5f, 0.25f});
    settings.black_level = map({0.02f, 0, 0.3f});
    Bytes const seen = walled(settings, source.shown());
    double const light = std::pow(128.0 / 255, 2.2);
    for (int const x : {3, 60})
        for (int k = 0; k < 3; ++k) {
            double const half = x < 32 ? 1 : 0.5, blend = half * std::array{1.0, 0.5, 0.25}[std::size_t(k)],
                         black = half * std::array{0.02, 0.0, 0.3}[std::size_t(k)];
            EXPECT_NEAR(seen[at(x, 20) + std::size_t(k)],
                        255 * std::pow(black + (1 - black) * blend * light, 1 / 2.2), 0.51);
        }
}

TEST_F(Wall, WindowsAndTexturesAreTheSameWayUp)
{
    Shown const shown;
    WallSettings settings;
    settings.blend.top = 0.5f;
    WallPass const pass(settings);
    TextureTarget const whole(Format::bytes, {100, 90});
    DrawTarget upright = part_of(whole.target(), {7, 9}, kWallSize), as_window = whole.target();
    pass.draw(upright, shown.target.shown());
    Bytes const a = read_bytes(upright);
    as_window.rows = RowOrder::top_last;
    as_window = part_of(as_window, {7, 9}, kWallSize);
    pass.draw(as_window, shown.target.shown());
    EXPECT_EQ(read_bytes(as_window), a);
    keep_picture("wall_top_blended", kWallSize, a);
}

/// Eyes are bent one by one and interlaced then: rows of the result are rows of one eye's wall.
TEST_F(Wall, BentWallsAreInterlacedAtTheEnd)
{
    Eyes const eyes(kWallSize, 4.0 / 3);
    DisplayPass display;
    WallSettings bent;
    bent.mesh.vertices[3].position = {0.9f, 0.8f};
    bent.blend.left = 0.2f;
    WallPass const wall(bent);
    std::vector<TextureTarget> walls;
    for (PictureTexture const* eye : {&eyes.left, &eyes.right}) {
        TextureTarget const flat(Format::bytes, kWallSize);
        display.draw(flat.target(), {eye->shown(), {}}, {}, {});
        walls.emplace_back(Format::bytes, kWallSize);
        wall.draw(walls.back().target(), flat.shown());
    }
    DisplaySettings settings;
    settings.values = PictureValues::encoded;
    settings.stereo = StereoMode::rows;
    TextureTarget const out(Format::bytes, kWallSize);
    display.draw(out.target(), {walls[0].shown(), {}}, {walls[1].shown(), {}}, settings);
    Bytes const seen = read_bytes(out.target());
    EXPECT_EQ(seen, compose_stereo(StereoMode::rows, read_bytes(walls[0].target()), read_bytes(walls[1].target()),
                                   kWallSize));
    keep_picture("wall_bent_rows", kWallSize, seen);
    keep_picture("wall_bent", kWallSize, read_bytes(walls[0].target()));
}

TEST_F(Wall, RefusesWhatIsNoWall)
{
    auto const refused = [](auto const& change) {
        WallSettings settings;
        change(settings);
        EXPECT_THROW(WallPass{settings}, gi::InputError);
    };
    refused([](WallSettings& s) { s.mesh.vertices.pop_back(); });
    refused([](WallSettings& s) { s.mesh.columns = 1; });
    refused([](WallSettings& s) { s.mesh.vertices[0].position.x = std::numeric_limits<float>::quiet_NaN(); });
    refused([](WallSettings& s) { s.mesh.vertices[0].weight = 1.5f; });
    refused([](WallSettings& s) { s.blend.left = -0.1f; });
    refused([](WallSettings& s) { s.blend.left = s.blend.right = 0.6f; });
    refused([](WallSettings& s) { s.blend.power = 0; });
    refused([](WallSettings& s) { s.gain.y = -1; });
    refused([](WallSettings& s) { s.gamma.z = 0; });
    auto const map = [](int width, int height, std::vector<glm::vec3> values) {
        return std::make_shared<PixelMap const>(PixelMap{width, height, std::move(values)});
    };
    refused([&](WallSettings& s) { s.blend_map = map(2, 2, {glm::vec3(1)}); });
    refused([&](WallSettings& s) { s.blend_map = map(1, 1, {glm::vec3(2)}); });
    refused([&](WallSettings& s) { s.black_level = map(1, 1, {glm::vec3(-1)}); });
    refused([&](WallSettings& s) { s.positions = map(2, 2, {}); });
}

} // namespace
} // namespace viewer::test
