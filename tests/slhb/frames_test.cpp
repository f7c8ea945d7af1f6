#include "gi/filter/temporal.h"
#include "gi/methods/reference/reference.h"
#include "gi/methods/paths/renderer.h"
#include "gi/scene/generate/figure.h"
#include "gi/scene/generate/generate.h"
#include "tests/slhb/slhb_render.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// A closed room with a displaced sphere, a lamp, and a figure that walks.
std::shared_ptr<Scene const> walk()
{
    Scene scene = generate_sphere(2000, 0);
    add_figure(scene, glm::translate(dmat4(1), dvec3{2.5, 1.5, 0}), 0.3);
    return std::make_shared<Scene const>(std::move(scene));
}

RenderSettings few_pixels(Schedule schedule)
{
    RenderSettings s;
    s.width = s.height = 40;
    s.paths = 2;
    s.bounces = 2;
    s.of<SlhbSettings>().schedule = schedule;
    if (schedule == Schedule::stored) s.of<SlhbSettings>().directions = "icosahedron:80";
    s.of<SlhbSettings>().resolution = 48;
    return s;
}

class Frames : public testing::TestWithParam<Schedule> {};

/// The third frame of a walk is, bit for bit, the picture of newly built structures.
TEST_P(Frames, AreThoseOfAWorldBuiltAnew)
{
    auto const scene = walk();
    Report report;
    MovingWorld moving(scene, 0, report);
    Camera const camera = moving.world().cameras.at(0);
    RenderSettings settings = few_pixels(GetParam());
    auto const frames = start_frames_as_set(moving, camera, settings, report);
    Picture last;
    for (double const t : {0.0, 0.3, 0.5}) {
        frames->changed(moving.advance(t));
        last = frames->frame(camera, {}, {}).picture;
    }
    ASSERT_LT(moving.world().static_triangles, moving.world().triangles.size());

    MovingWorld const anew(scene, 0.5, report);
    TriangleSoup soup = make_soup(anew.world());
    settings = choose_frame_settings(with(algorithm_as_set(settings), settings), anew.world(), soup);
    FrameView const eye{camera, settings.width, settings.height};
    PathsRenderer renderer(anew.world(), {&eye, 1}, settings, std::move(soup), anew.world().triangles.size(),
                          report);
    Accumulator sums(settings.width, settings.height);
    for (std::uint32_t pass = 0; pass < 6; ++pass) {
        Accumulator unused(settings.width, settings.height);
        renderer.pass(pass, {pass < 4 ? &unused : &sums, 1}, VertexSharing::exact, PassStop(nullptr));
    }
    EXPECT_EQ(last.find("color")->data, sums.picture(anew.world()).find("color")->data);
}

INSTANTIATE_TEST_SUITE_P(Schedules, Frames,
                         testing::Values(Schedule::stored, Schedule::temporal, Schedule::streamed));

/// Where the figure walks there is motion, and nowhere else.
TEST(MotionVectors, AreThoseOfWhatMoves)
{
    auto const scene = walk();
    Report report;
    MovingWorld moving(scene, 0, report);
    Camera const camera = moving.world().cameras.at(0);
    RenderSettings settings = few_pixels(Schedule::streamed);
    settings.width = settings.height = 128;
    settings.paths = 1;
    auto const frames = start_frames_as_set(moving, camera, settings, report);
    frames->frame(camera, {}, {});
    frames->changed(moving.advance(0.1));
    Picture const p = frames->frame(camera, {}, {}).picture;
    std::size_t still = 0, moves = 0;
    for (std::size_t i = 0; i < p.pixels(); ++i) {
        vec3 const m = rgb(*p.find("motion"), i);
        if (m.x == 0 && m.y == 0) {
            ++still;
            EXPECT_NEAR(m.z, p.find("depth")->data[i], 1e-3f);
        } else {
            ++moves;
            EXPECT_LT(glm::length(vec2(m)), 30);
        }
    }
    EXPECT_GT(still, p.pixels() / 2);
    EXPECT_GT(moves, 50u);

    // The camera goes a step: all that is seen moves, and a point straight ahead as a projection says.
    Camera aside = camera;
    aside.world_from_camera = camera.world_from_camera * glm::translate(dmat4(1), dvec3{0.1, 0, 0});
    Picture const q = frames->frame(aside, {}, {}).picture;
    std::size_t const middle = q.pixels() / 2 + std::size_t(q.width) / 2;
    float const depth = q.find("depth")->data[middle];
    double const per_m = q.height / (2 * std::tan(0.5 * camera.yfov_rad) * double(depth));
    EXPECT_NEAR(double(rgb(*q.find("motion"), middle).x), 0.1 * per_m, 0.02 * per_m);
}

/// A lamp that is switched off leaves nothing in the very first frame after it.
TEST(TemporalFrames, ALightSwitchedOffIsOff)
{
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.6f}));
    add_box(scene, {-2, -2, -2}, {2, 2, 2}, m, true);
    Light light;
    light.type = LightType::point;
    light.intensity = vec3{10};
    scene.lights = {light};
    Node node;
    node.light = 0;
    node.translation = {0.5, 1, 0.2};
    scene.nodes.push_back(node);
    Report report;
    MovingWorld world(std::make_shared<Scene const>(std::move(scene)), 0, report);
    Camera const camera = look_at({0, 0, 1.9}, {0, 0, -1}, 70);
    auto const frames = start_frames_as_set(world, camera, few_pixels(Schedule::streamed), report);
    TemporalReuse reuse({});
    auto const show = [&](SceneChange change) {
        Picture p = frames->frame(camera, {}, {}).picture;
        reuse.add(p, change);
        double sum = 0;
        for (float const v : p.find("color")->data) sum += double(v);
        return sum;
    };
    show(SceneChange::light);
    for (int k = 0; k < 10; ++k) EXPECT_GT(show(SceneChange::nothing), 0);
    Light dark = world.world().lights.at(0);
    dark.intensity = vec3{0};
    Changes const changes = world.set_light(0, dark);
    EXPECT_TRUE(changes.lights);
    frames->changed(changes);
    EXPECT_EQ(show(SceneChange::light), 0);
    EXPECT_EQ(show(SceneChange::nothing), 0);
}

/// A still picture of many frames has the error of as many paths.
TEST(TemporalFrames, AStillPictureIsTheRenderOfAllItsPaths)
{
    auto const scene = walk();
    Report report;
    MovingWorld world(scene, 0, report);
    Camera const camera = world.world().cameras.at(0);
    RenderSettings settings = few_pixels(Schedule::streamed);
    settings.paths = 1;
    auto const frames = start_frames_as_set(world, camera, settings, report);
    TemporalReuse reuse({.most_frames = 4});
    Picture p;
    for (int k = 0; k < 24; ++k) {
        p = frames->frame(camera, {}, {}).picture;
        reuse.add(p, k == 0 ? SceneChange::light : SceneChange::nothing);
    }
    settings.paths = 24;
    auto const all = start_frames_as_set(world, camera, settings, report);
    Picture const q = all->frame(camera, {}, {}).picture;
    for (std::size_t k = 0; k < p.find("color")->data.size(); ++k)
        ASSERT_NEAR(p.find("color")->data[k], q.find("color")->data[k], 1e-4f * (1 + q.find("color")->data[k]));
}

/// Means of L1 and L2 over frames of one pass.
std::array<double, 2> light_of_frames(StartFrames start, RenderSettings const& settings, int frames)
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(box_with_block_and_lamp()), 0, report);
    Camera const camera = look_at({-0.6, 0.1, 0.9}, {0.1, -0.4, 0}, 60);
    auto const renderer = start(world, camera, settings, report);
    std::array<double, 2> sum{};
    for (int k = 0; k < frames; ++k) {
        Picture const p = renderer->frame(camera, {}, {}).picture;
        sum[0] += mean_of(p, "L1").mean / frames;
        sum[1] += mean_of(p, "L2").mean / frames;
    }
    return sum;
}

TEST(InterleavedFrames, HaveTheLightOfAllPixels)
{
    constexpr int kFrames = 96;
    constexpr double kNoTime = 1e-9, kWithin = 0.01; // of which the surfaces' edges have a part
    RenderSettings s;
    s.width = s.height = 48;
    s.bounces = 3;
    s.paths = 1;
    auto const [direct, indirect] = light_of_frames(start_slhb_frames, s, kFrames);
    auto const expect_same = [&](std::array<double, 2> const& light, std::string const& what) {
        EXPECT_NEAR(light[0], direct, kWithin * direct) << what;
        EXPECT_NEAR(light[1], indirect, kWithin * indirect) << what;
    };
    for (int const n : {2, 3, 4}) {
        s.of<PathsSettings>().interleave = n;
        expect_same(light_of_frames(start_slhb_frames, s, kFrames), fmt::format("slhb, {}", n));
    }
    s.of<PathsSettings>().interleave = 0;
    s.budget_s = kNoTime; // one pass a frame, one of 4 x 4 pixels
    expect_same(light_of_frames(start_slhb_frames, s, kFrames), "slhb, by time");
    expect_same(light_of_frames(start_reference_frames, s, kFrames), "reference, by time");
}

} // namespace
} // namespace gi::test
