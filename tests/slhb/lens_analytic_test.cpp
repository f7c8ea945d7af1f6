// Depth of field, by three methods: the circle of confusion of the thin lens, its energy, and what is in focus.

#include "gi/filter/reused_light.h"
#include "gi/methods/reference/reference.h"
#include "gi/methods/registry.h"
#include "tests/slhb/blur_shapes.h"
#include "tests/slhb/slhb_render.h"

namespace gi::test {
namespace {

constexpr double kRadius = 0.4, kFocus = 2;

Camera eye(bool lens)
{
    Camera camera = look_at({0, 0, 0}, {0, 0, -1}, 30);
    if (lens) {
        camera.aperture_radius_m = kRadius;
        camera.focus_distance_m = kFocus;
    }
    return camera;
}

/// A luminous square of side 4 pixels before the middle of the view.
Scene luminous_square(double depth)
{
    Scene scene;
    float const d = float(depth), half = float(2 * pixel_tangent() * depth);
    add_quad(scene, {-half, -half, -d}, {2 * half, 0, 0}, {0, 2 * half, 0},
             add_material(scene, emitter(vec3{1}, true)));
    return scene;
}

class Lens : public testing::TestWithParam<char const*> {
protected:
    Picture render(World const& world, Camera const& camera, RenderSettings const& s) const
    {
        Report report;
        return find_method(GetParam()).render(world, camera, s, {}, {}, report).picture;
    }
};

/// Nearer and farther than the plane in focus. A square of side a, a disk of radius c and the pixel have, in each
/// direction, the variance a^2 / 12 + c^2 / 4 + 1 / 12 px^2, and all light is still there.
TEST_P(Lens, TheCircleOfConfusionHasTheSizeOfTheThinLens)
{
    for (double const depth : {1.4, 4.0}) {
        Picture const p = render(world_of(luminous_square(depth)), eye(true),
                                 blur_settings(std::string(GetParam()) == "paths_layered_lens" ? 256 : 2048));
        double const c = kRadius * std::abs(depth - kFocus) / (depth * kFocus) / pixel_tangent();
        BlurShape const shape = measure(p);
        EXPECT_NEAR(shape.sum, 16, 0.02 * 16) << depth;
        EXPECT_NEAR(shape.mean.x, kBlurSize / 2.0, 0.1) << depth;
        EXPECT_NEAR(shape.mean.y, kBlurSize / 2.0, 0.1) << depth;
        double const variance = 16 / 12.0 + c * c / 4 + 1 / 12.0;
        EXPECT_NEAR(shape.variance.x, variance, 0.02 * variance) << depth;
        EXPECT_NEAR(shape.variance.y, variance, 0.02 * variance) << depth;
        double inside = 0;
        int pixels = 0;
        for (int y = 0; y < kBlurSize; ++y)
            for (int x = 0; x < kBlurSize; ++x) {
                double const r = glm::length(dvec3{x + 0.5 - kBlurSize / 2.0, y + 0.5 - kBlurSize / 2.0, 0});
                float const value = p.find("L0")->data[3 * (std::size_t(y) * kBlurSize + std::size_t(x))];
                if (r > c + 2 * std::sqrt(2.0) + 1) {
                    EXPECT_EQ(value, 0) << x << " " << y;
                }
                if (r > c - 3.5) continue;
                inside += double(value);
                ++pixels;
            }
        ASSERT_GT(pixels, 20);
        double const flat = 16 / (double(kPi) * c * c);
        EXPECT_NEAR(inside / pixels, flat, 0.03 * flat) << "the disk is even, " << depth;
    }
}

/// In focus all is as a pinhole sees it, up to the noise.
TEST_P(Lens, ThePlaneInFocusIsSharp)
{
    World const world = world_of(luminous_square(kFocus));
    Picture const sharp = render(world, eye(false), blur_settings(256)),
                  lens = render(world, eye(true), blur_settings(256));
    double most = 0;
    for (std::size_t k = 0; k < sharp.find("L0")->data.size(); ++k)
        most = std::max(most, std::abs(double(sharp.find("L0")->data[k]) - double(lens.find("L0")->data[k])));
    // Of a pixel that is half covered, 256 paths know the share to 0.03; passes of slhb share their places.
    EXPECT_LT(most, std::string(GetParam()) == "reference" ? 0.2 : 0.02);
}

/// A lens of radius 0 is no lens, bit for bit, whatever it focuses on.
TEST_P(Lens, APinholeIsAPinhole)
{
    World const world = world_of(box_with_block_and_lamp());
    Camera closed = look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 60);
    Picture const pinhole = render(world, closed, small_settings(24, 4, 2));
    closed.focus_distance_m = 1;
    EXPECT_EQ(render(world, closed, small_settings(24, 4, 2)).find("color")->data, pinhole.find("color")->data);
}

INSTANTIATE_TEST_SUITE_P(Methods, Lens, testing::Values("slhb", "reference", "paths_layered_lens"));

/// A block before a room, out of focus: both methods agree, and a pinhole sees something else.
TEST(LensOfBothMethods, GivesThePictureOfTheReference)
{
    World const world = world_of(box_with_block_and_lamp());
    Camera camera = look_at({0.1, -0.3, 0.95}, {-0.1, -0.5, 0}, 70);
    camera.aperture_radius_m = 0.15;
    camera.focus_distance_m = 1.9; // the wall behind
    RenderSettings s = small_settings(48, 256, 2);
    s.of<SlhbSettings>().resolution = 96;
    Report report;
    Picture const expected = render_reference(world, camera, s, {}, {}, report).picture,
                  found = render_small(world, camera, s).result.picture,
                  gathered = render_layered_lens(world, camera, s, {}, {}, report).picture;
    camera.aperture_radius_m = 0;
    Picture const sharp = render_small(world, camera, s).result.picture;
    for (Picture const* const picture : {&found, &gathered}) {
        EXPECT_LT(block_distance(*picture, expected), 0.03 * mean_of(expected).mean);
        EXPECT_GT(block_distance(sharp, expected), 3 * block_distance(*picture, expected));
    }
    for (char const* const layer : {"L0", "L1", "L2"}) {
        double const wanted = mean_of(expected, layer).mean;
        EXPECT_NEAR(mean_of(gathered, layer).mean, wanted, 0.02 * wanted) << layer;
    }
}

/// Blurred pixels have less noise by as many paths, since they gather from those of others.
TEST(LayeredLens, HasLessNoiseByAsManyPaths)
{
    World const world = world_of(box_with_block_and_lamp());
    Camera camera = look_at({0.1, -0.3, 0.95}, {-0.1, -0.5, 0}, 70);
    camera.aperture_radius_m = 0.3;
    camera.focus_distance_m = 0.5;
    RenderSettings const s = small_settings(48, 16, 2);
    Report report;
    double const sampled = render_paths(world, camera, s, {}, {}, report).relmse;
    EXPECT_LT(render_layered_lens(world, camera, s, {}, {}, report).relmse, 0.5 * sampled);
    camera.aperture_radius_m = 0;
    EXPECT_EQ(render_layered_lens(world, camera, s, {}, {}, report).picture.find("color")->data,
              render_paths(world, camera, s, {}, {}, report).picture.find("color")->data)
        << "no lens, nothing else";
}

/// Frames of two eyes: motion of what stands still is none, hidden pixels are left out, and a frame has the light of a still.
TEST(LayeredLens, OfFramesAndEyes)
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(box_with_block_and_lamp()), 0, report);
    Camera camera = look_at({0.1, -0.3, 0.95}, {-0.1, -0.5, 0}, 70);
    camera.aperture_radius_m = 0.1;
    camera.focus_distance_m = 0.8;
    RenderSettings const s = small_settings(32, 1, 1);
    auto const frames = start_layered_lens_frames(world, camera, s, report);
    std::vector<std::uint8_t> hidden(32 * 32, 0);
    std::fill(hidden.begin(), hidden.begin() + 32, 1);
    std::vector<FrameView> views{{camera, 32, 32}, {camera, 32, 32}};
    views[1].partner = 0;
    views[1].hidden = hidden;
    for (int k = 0; k < 2; ++k) {
        std::vector<RenderResult> const results = frames->views(views, 64, VertexSharing::exact, {});
        Layer const* const motion = results[0].picture.find("motion");
        ASSERT_NE(motion, nullptr);
        for (std::size_t i = 0; i < results[0].picture.pixels(); ++i)
            ASSERT_NEAR(glm::length(vec2(rgb(*motion, i))), 0, 1e-3f); // z is depth
        EXPECT_EQ(rgb(*results[1].picture.find("color"), 5), vec3{0}) << "hidden";
        EXPECT_NE(rgb(*results[1].picture.find("color"), 500), vec3{0});
        EXPECT_EQ(std::ranges::count(results[1].light_from, kOwnLight), 32 * 32);
        RenderSettings still = s;
        still.paths = 256;
        double const wanted = mean_of(render_reference(world.world(), camera, still, {}, {}, report).picture).mean;
        EXPECT_NEAR(mean_of(results[0].picture).mean, wanted, 0.05 * wanted);
    }
}

/// A card that shines on one side, beside a wide lens: its other side, which the rim sees, is dark.
TEST(LayeredLens, ShadesTheSideThatALensRaySees)
{
    Scene scene = box_with_block_and_lamp();
    Camera camera = look_at({0, 0, 0.9}, {0, 0, -1}, 60);
    camera.aperture_radius_m = 0.3;
    camera.focus_distance_m = 1.8;
    add_quad(scene, {0.05f, -0.3f, 0.5f}, {0, 0, -0.4f}, {0, 0.6f, 0}, add_material(scene, emitter(vec3{20})));
    World const world = world_of(std::move(scene));
    RenderSettings const s = small_settings(48, 256, 1);
    Report report;
    Picture const expected = render_reference(world, camera, s, {}, {}, report).picture,
                  sampled = render_paths(world, camera, s, {}, {}, report).picture,
                  gathered = render_layered_lens(world, camera, s, {}, {}, report).picture;
    double const wanted = mean_of(expected, "L0").mean;
    EXPECT_NEAR(mean_of(gathered, "L0").mean, wanted, 0.02 * wanted);
    EXPECT_LT(block_distance(gathered, expected), 1.2 * block_distance(sampled, expected)); // both with its noise
}

/// Blocks on a floor, which is one rectangle: within the blocks it is dark, and pixels beside them are not.
TEST(LayeredLens, TakesNoLightFromWithinWhatStandsOnAFloor)
{
    Scene scene;
    int const grey = add_material(scene, lambert(vec3{0.6f}));
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, grey, true);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
    for (int i = 0; i < 25; ++i) {
        vec3 const at{-0.8f + 0.4f * float(i % 5), -1, -0.8f + 0.3f * float(i / 5)};
        add_box(scene, at - vec3{0.08f, 0, 0.08f}, at + vec3{0.08f, 0.1f, 0.08f}, grey, false);
    }
    World const world = world_of(std::move(scene));
    Camera camera = look_at({0, 0, 0.95}, {0, -0.9, -0.2}, 60);
    camera.aperture_radius_m = 0.02;
    camera.focus_distance_m = 0.7;
    RenderSettings const s = small_settings(32, 512, 1);
    Report report;
    Picture const sampled = render_paths(world, camera, s, {}, {}, report).picture,
                  gathered = render_layered_lens(world, camera, s, {}, {}, report).picture;
    for (char const* const layer : {"L1", "L2"}) {
        double const wanted = mean_of(sampled, layer).mean;
        EXPECT_NEAR(mean_of(gathered, layer).mean, wanted, 0.005 * wanted) << layer;
    }
}

/// Where a blurred edge ends, alpha and what denoisers are given are those of sampled lenses.
TEST(LayeredLens, AlphaAndAlbedoOfABlurredEdge)
{
    Scene scene;
    add_quad(scene, {-5, -5, -4}, {5, 0, 0}, {0, 10, 0}, add_material(scene, lambert(vec3{0.7f})));
    scene.background.kind = BackgroundKind::transparent;
    World const world = world_of(std::move(scene));
    Camera camera = look_at({0, 0, 0}, {0, 0, -1}, 60);
    camera.aperture_radius_m = 0.4;
    camera.focus_distance_m = 1;
    RenderSettings const s = small_settings(32, 512, 0);
    Report report;
    Picture const expected = render_reference(world, camera, s, {}, {}, report).picture,
                  gathered = render_layered_lens(world, camera, s, {}, {}, report).picture;
    for (std::size_t i = 0; i < expected.pixels(); ++i) {
        double const alpha = double(expected.find("alpha")->data[i]);
        ASSERT_NEAR(double(gathered.find("alpha")->data[i]), alpha, 0.12) << i;
        if (alpha > 0.2) {
            ASSERT_NEAR(rgb(*gathered.find("albedo"), i).x, rgb(*expected.find("albedo"), i).x, 0.02f) << i;
        }
    }
}

} // namespace
} // namespace gi::test
