// Motion blur: while the shutter is open, every path sees a moment of its own, or, by paths_layered_lens, gathers from
// several.

#include "gi/methods/reference/reference.h"
#include "gi/metrics/metrics.h"
#include "gi/render/pass_samples.h"
#include "tests/slhb/blur_shapes.h"
#include "tests/slhb/slhb_render.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

constexpr double kDepth = 2, kSide_px = 4, kWay_px = 12;

double metres(double px) { return px * pixel_tangent() * kDepth; }

/// The last node goes along x, from where it is, in one second.
void move_last_node(Scene& scene, double way_m)
{
    AnimationChannel channel;
    channel.node = std::int32_t(scene.nodes.size()) - 1;
    channel.times_s = {0, 1};
    channel.values = {0, 0, 0, float(way_m), 0, 0};
    Animation clip;
    clip.channels = {channel};
    clip.duration_s = 1;
    scene.animations = {clip};
    scene.playbacks = {{0, 0, 1, false}};
}

/// A luminous square whose middle starts 6 pixels left of that of the view.
Scene luminous_square()
{
    Scene scene;
    float const half = float(metres(0.5 * kSide_px)), x = float(metres(-0.5 * kWay_px));
    add_quad(scene, {x - half, -half, -float(kDepth)}, {2 * half, 0, 0}, {0, 2 * half, 0},
             add_material(scene, emitter(vec3{1}, true)));
    return scene;
}

Camera eye() { return look_at({0, 0, 0}, {0, 0, -1}, 30); }

class Shutter : public testing::TestWithParam<char const*> {
protected:
    static std::unique_ptr<FrameRenderer> start(MovingWorld const& world, RenderSettings const& s, Report& report)
    {
        bool const slhb = std::string(GetParam()) == "slhb";
        return (slhb ? start_slhb_frames : start_reference_frames)(world, eye(), s, report);
    }
};

/// The square's profile along x, convolved with its way and with the pixel: share of the time that a place is
/// covered, over columns.
void expect_trapezoid(Picture const& p)
{
    BlurShape const shape = measure(p);
    double const area = kSide_px * kSide_px;
    EXPECT_NEAR(shape.sum, area, 0.01 * area);
    EXPECT_NEAR(shape.mean.x, kBlurSize / 2.0, 0.1);
    EXPECT_NEAR(shape.mean.y, kBlurSize / 2.0, 0.1);
    double const low = 0.5 * (kBlurSize - kWay_px - kSide_px), high = low + kWay_px + kSide_px;
    for (int x = 0; x < kBlurSize; ++x) {
        double expected = 0, found = 0;
        constexpr int kParts = 64;
        for (int k = 0; k < kParts; ++k) {
            double const u = x + (k + 0.5) / kParts;
            expected += std::clamp(std::min(u - low, high - u), 0.0, kSide_px) / kWay_px * kSide_px / kParts;
        }
        for (int y = 0; y < kBlurSize; ++y)
            found += double(p.find("L0")->data[3 * (std::size_t(y) * kBlurSize + std::size_t(x))]);
        EXPECT_NEAR(found, expected, 0.05 * kSide_px * kSide_px / kWay_px) << x;
    }
}

TEST_P(Shutter, AMovingSquareLeavesATrapezoid)
{
    Scene scene = luminous_square();
    move_last_node(scene, metres(kWay_px));
    Report report;
    MovingWorld world(std::make_shared<Scene const>(std::move(scene)), 0, report);
    RenderSettings const s = blur_settings(512);
    Moments const moments = [&](std::uint32_t pass) {
        return Moment{world.advance(moment_of_pass(s.seed, pass)), eye()};
    };
    Picture const p = start(world, s, report)->frame(eye(), {}, {}, moments).picture;
    EXPECT_EQ(p.find("motion"), nullptr);
    expect_trapezoid(p);
}

/// As if the square moved the other way.
TEST_P(Shutter, AMovingCameraLeavesATrapezoid)
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(luminous_square()), 0, report);
    RenderSettings const s = blur_settings(512);
    Moments const moments = [&](std::uint32_t pass) {
        Camera camera = eye();
        camera.world_from_camera[3].x = -metres(kWay_px) * moment_of_pass(s.seed, pass);
        return Moment{{}, camera};
    };
    expect_trapezoid(start(world, s, report)->frame(eye(), {}, {}, moments).picture);
}

/// Bit for bit.
TEST_P(Shutter, MomentsThatAreAllTheSameArePicturesOfAMoment)
{
    Scene scene = box_with_block_and_lamp();
    move_last_node(scene, 0.5);
    Report report;
    MovingWorld world(std::make_shared<Scene const>(std::move(scene)), 0, report);
    RenderSettings const s = small_settings(24, 6, 2);
    Camera const camera = look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70);
    Moments const moments = [&](std::uint32_t) { return Moment{world.advance(0), camera}; };
    EXPECT_EQ(start(world, s, report)->frame(camera, {}, {}, moments).picture.find("color")->data,
              start(world, s, report)->frame(camera, {}, {}).picture.find("color")->data);
}

/// What moved between two frames is where it is now.
TEST_P(Shutter, FramesSeeWhatHasMoved)
{
    Scene scene = luminous_square();
    move_last_node(scene, metres(kWay_px));
    Report report;
    MovingWorld world(std::make_shared<Scene const>(std::move(scene)), 0, report);
    auto const frames = start(world, blur_settings(256), report);
    EXPECT_NEAR(measure(frames->frame(eye(), {}, {}).picture).mean.x, 0.5 * (kBlurSize - kWay_px), 0.1);
    frames->changed(world.advance(1));
    EXPECT_NEAR(measure(frames->frame(eye(), {}, {}).picture).mean.x, 0.5 * (kBlurSize + kWay_px), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Methods, Shutter, testing::Values("slhb", "reference"));

/// A block that moves through a room, its shadow and its light.
TEST(ShutterOfBothMethods, GivesThePictureOfTheReference)
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.6f})), true);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
    add_box(scene, {-0.8f, -1, -0.4f}, {-0.3f, 0, 0.2f}, add_material(scene, lambert(vec3{0.2f, 0.3f, 0.1f})),
            false);
    move_last_node(scene, 0.9);
    Report report;
    MovingWorld world(std::make_shared<Scene const>(std::move(scene)), 0, report);
    Camera const camera = look_at({0, 0, 0.95}, {0, -0.4, 0}, 80);
    RenderSettings s = small_settings(48, 256, 2);
    s.of<SlhbSettings>().resolution = 96;
    Moments const moments = [&](std::uint32_t pass) {
        return Moment{world.advance(moment_of_pass(s.seed, pass)), camera};
    };
    Picture const expected =
        start_reference_frames(world, camera, s, report)->frame(camera, {}, {}, moments).picture;
    world.advance(0);
    Picture const found = start_frames_as_set(world, camera, s, report)->frame(camera, {}, {}, moments).picture;
    world.advance(0.5);
    Picture const frozen = start_frames_as_set(world, camera, s, report)->frame(camera, {}, {}).picture;
    double const mean = mean_of(expected).mean;
    EXPECT_LT(block_distance(found, expected), 0.03 * mean);
    EXPECT_GT(block_distance(frozen, expected), 3 * block_distance(found, expected));
}

/// A camera that passes the box and turns, with and without a lens. While all else stands still, passes may gather.
class GatheredShutter : public testing::TestWithParam<double> {
protected:
    static Camera at(double moment)
    {
        Camera camera = look_at({0.1 + 0.2 * moment, -0.3, 0.95}, {-0.1 + 0.5 * moment, -0.5, 0}, 70);
        if (GetParam() > 0) {
            camera.aperture_radius_m = GetParam();
            camera.focus_distance_m = 0.8;
        }
        return camera;
    }
    static RenderResult expose(StartFrames start, RenderSettings const& s, bool gathers = true)
    {
        Report report;
        MovingWorld const world(std::make_shared<Scene const>(box_with_block_and_lamp()), 0, report);
        Moments const moments = [&](std::uint32_t pass) {
            Moment now{{}, at(moment_of_pass(s.seed, pass))};
            if (gathers) now.camera_at = at;
            return now;
        };
        return start(world, at(0), s, report)->frame(at(0), {}, {}, moments);
    }
};

/// What differs becomes less with the noise of both, as does the difference of their means.
TEST_P(GatheredShutter, BecomesThePictureOfSampledMoments)
{
    RenderSettings s = small_settings(32, 2048, 1);
    Picture const sampled = expose(start_path_frames, s).picture;
    s.seed = 6;
    s.paths = 64;
    Picture const few = expose(start_layered_lens_frames, s).picture;
    s.paths = 1024;
    Picture const many = expose(start_layered_lens_frames, s).picture;
    auto const relmse = [&](Picture const& p) {
        return measure_errors(p.find("color")->data, sampled.find("color")->data, 3).relmse;
    };
    EXPECT_LT(relmse(many), 0.35 * relmse(few)); // both contain the noise of sampled moments
    double const wanted = mean_of(sampled).mean;
    EXPECT_NEAR(mean_of(many).mean, wanted, 0.005 * wanted);
    for (char const* const layer : {"L0", "L1", "L2"})
        EXPECT_NEAR(mean_of(many, layer).mean, mean_of(sampled, layer).mean, 0.01 * wanted) << layer;
}

TEST_P(GatheredShutter, HasLessNoiseByAsManyPaths)
{
    RenderSettings const s = small_settings(48, 16, 2);
    EXPECT_LT(expose(start_layered_lens_frames, s).relmse, 0.5 * expose(start_path_frames, s).relmse);
    EXPECT_EQ(expose(start_layered_lens_frames, s).picture.find("color")->data,
              expose(start_layered_lens_frames, s).picture.find("color")->data);
}

/// Where the world moves as well, a pass has one moment.
TEST_P(GatheredShutter, OfAMovingWorldHasTheMomentsOfPasses)
{
    RenderSettings const s = small_settings(24, 4, 1);
    bool const same = expose(start_layered_lens_frames, s, false).picture.find("color")->data ==
                      expose(start_path_frames, s, false).picture.find("color")->data;
    EXPECT_EQ(same, GetParam() == 0) << "a lens is gathered from all the same";
}

INSTANTIATE_TEST_SUITE_P(Lenses, GatheredShutter, testing::Values(0.0, 0.05));

TEST(GatheredShutterOfASquare, LeavesATrapezoid)
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(luminous_square()), 0, report);
    RenderSettings const s = blur_settings(256);
    auto const at = [](double moment) {
        Camera camera = eye();
        camera.world_from_camera[3].x = -metres(kWay_px) * moment;
        return camera;
    };
    Moments const moments = [&](std::uint32_t pass) { return Moment{{}, at(moment_of_pass(s.seed, pass)), at}; };
    expect_trapezoid(start_layered_lens_frames(world, eye(), s, report)->frame(eye(), {}, {}, moments).picture);
}

} // namespace
} // namespace gi::test
