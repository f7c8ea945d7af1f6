// What the method auto chooses between look-ups and exact rays, and that its choice is right where look-ups were not.

#include "gi/methods/automatic/automatic.h"
#include "gi/methods/reference/reference.h"
#include "gi/methods/registry.h"
#include "gi/methods/slhb_0_1/slhb_0_1.h"
#include "gi/scene/generate/generate.h"
#include "gi/methods/paths/look_up_trust.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/stop_at_ask.h"

namespace gi::test {
namespace {

double agreement(World const& world, Camera const& camera, int resolution, int levels = 1)
{
    SlhbSettings settings;
    settings.resolution = resolution;
    settings.levels = levels;
    return look_up_agreement(world, make_soup(world), camera_rays(camera, 48, 48, world.origin), settings);
}

TEST(RayPlan, LookUpsAreNotTrustedInARoomOfALargeWorld)
{
    EXPECT_LT(agreement(world_of(room_on_a_plane(5000)), kInRoom, 256), 0.5);
    EXPECT_LT(agreement(world_of(room_on_a_plane(50)), kInRoom, 64), 0.8);
    for (float const reach : {50.0f, 500.0f, 5000.0f}) // with windows around the camera
        EXPECT_GT(agreement(world_of(room_on_a_plane(reach)), kInRoom, 256, 0), kTrustedLookUps) << reach;
    EXPECT_LT(agreement(world_of(village()), look_at({0, 10, 40}, {0, 2, -60}, 60), 256), 0.8);
    Scene closed;
    add_box(closed, {-1, -1, -1}, {1, 1, 1}, add_material(closed, lambert(vec3{0.6f})), true);
    EXPECT_GT(agreement(world_of(std::move(closed)), look_at({0, 0, 0}, {1, 0.2, 0.1}, 70), 256), 0.9);
}

/// Means of direct and indirect light are those of the reference, with a plane of any size around the room.
TEST(RayPlan, RoomOnAWidePlane)
{
    for (float const reach : {10.0f, 5000.0f}) {
        World const world = world_of(room_on_a_plane(reach));
        RenderSettings s = small_settings(32, 256, 3);
        StopRequest stop;
        Report report;
        Picture const truth = render_reference(world, kInRoom, s, stop, {}, report).picture;
        Picture const seen = render_small(world, kInRoom, s).result.picture;
        for (char const* const layer : {"L1", "L2"}) {
            double const t = mean_of(truth, layer).mean;
            EXPECT_NEAR(mean_of(seen, layer).mean, t, 0.01 * t) << layer << ", plane of " << reach << " m";
        }
    }
}

/// The last matt surface still finds the lamp by the mirror.
TEST(RayPlan, LampsInMirrors)
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.6f})), true);
    add_quad(scene, {-0.99f, -1, 1}, {0, 0, -2}, {0, 2, 0}, add_material(scene, mirror(vec3{0.9f})));
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
    World const world = world_of(std::move(scene));
    Camera const camera = look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70);
    for (int const bounces : {0, 1}) {
        RenderSettings s = small_settings(24, 512, bounces);
        StopRequest stop;
        Report report;
        double const truth = mean_of(render_reference(world, camera, s, stop, {}, report).picture).mean;
        for (auto const& [name, render] : std::initializer_list<std::pair<char const*, RenderFunction>>{
                 {"slhb", render_slhb}, {"paths", render_paths}})
            EXPECT_NEAR(mean_of(render(world, camera, s, stop, {}, report).picture).mean, truth, 0.01 * truth)
                << name << ", bounces " << bounces;
    }
}

TEST(RayPlan, ChoosesLookUpsOnlyWhereABvhTakesTooLongAndTheyAreRight)
{
    Scene closed;
    int const wall = add_material(closed, lambert(vec3{0.6f}));
    add_box(closed, {-1, -1, -1}, {1, 1, 1}, wall, true);
    add_sphere(closed, {1.5f, 0, 0}, 0.2f, 7, wall, false); // out of sight: 327,680 triangles
    World const wide = world_of(room_on_a_plane(5000)), world = world_of(std::move(closed));
    Camera const camera = look_at({0, 0, 0}, {1, 0.2, 0.1}, 70);
    RenderSettings asked = small_settings(64, 16, 3);
    EXPECT_EQ(choose_method(world, asked, camera, RenderUse::picture).method, "paths");
    asked.budget_s = 1e-3;
    MethodChoice const choice = choose_method(world, asked, camera, RenderUse::picture);
    EXPECT_EQ(choice.method, "slhb");
    EXPECT_NE(choice.why.text.find("a BVH takes about 0.13 s of one core"), std::string::npos) << choice.why.text;
    EXPECT_EQ(choose_method(world, asked, camera, RenderUse::frames).method, "paths");
    asked.budget_s = 1e-9;
    EXPECT_EQ(choose_method(wide, asked, kInRoom, RenderUse::picture).method, "paths");
    asked.space = Space::device;
    EXPECT_EQ(choose_method(world, asked, camera, RenderUse::picture).method, "reference");
}

TEST(RayPlan, ABudgetChoosesTheCacheAndRoulette)
{
    World const world = world_of(room_on_a_plane(50));
    TriangleSoup const soup = make_soup(world);
    RenderSettings asked = small_settings(64, 16, 3);
    EXPECT_EQ(choose_settings(asked, world, soup).of<PathsSettings>().roulette, 0);
    asked.budget_s = 1;
    PathsSettings const paths = choose_settings(asked, world, soup).of<PathsSettings>(),
                        slhb = choose_settings(with(kSlhb, asked), world, soup).of<PathsSettings>();
    EXPECT_EQ(paths.roulette, 3);
    EXPECT_EQ(paths.cache, RadianceCaching::on);
    EXPECT_EQ(slhb.roulette, 2);
    EXPECT_EQ(slhb.cache, RadianceCaching::off);
}

/// What version 0.1 called slhb is rays or look-ups, by its options.
TEST(RayPlan, SlhbOf01DoesWhatItDid)
{
    World const world = world_of(box_with_block_and_lamp());
    Camera const camera = look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70);
    StopRequest stop;
    Report report;
    auto const same = [&](RenderFunction now, std::vector<std::pair<char const*, char const*>> const& options) {
        RenderSettings s = small_settings(16, 2, 2);
        s.of<SlhbSettings>().confirm = Confirming::off;
        for (auto const& [name, value] : options) render_option(name).set(s, value, name);
        return render_slhb_0_1(world, camera, s, stop, {}, report).picture.find("color")->data ==
               now(world, camera, s, stop, {}, report).picture.find("color")->data;
    };
    EXPECT_TRUE(same(render_paths, {}));
    EXPECT_TRUE(same(render_slhb, {{"look-ups", "all"}, {"shadows", "maps"}}));
    EXPECT_TRUE(same(render_slhb, {{"axes", "4"}}));
    EXPECT_TRUE(same(render_slhb, {{"hit-buffer", "32"}}));
    EXPECT_TRUE(same(SlhbShadowRays::render, {{"look-ups", "all"}, {"shadows", "rays"}}));
    EXPECT_TRUE(same(PathsShadowMaps::render, {{"light-samples", "4"}}));
    EXPECT_FALSE(same(render_slhb, {}));
}

TEST(RayPlan, BuffersStayWithinTheirMemory)
{
    World const world = world_of(box_with_block_and_lamp());
    RenderSettings s = small_settings(8, 4, 2);
    s.of<SlhbSettings>().schedule = Schedule::stored;
    s.of<SlhbSettings>().resolution = 256;
    s.of<SlhbSettings>().memory_mib = 64; // 160 axes of 256 x 256 take about 500
    SlhbRun const run = render_small(world, look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70), s);
    std::string const what = "times the resolution of hit buffers was halved to stay within --memory";
    ASSERT_EQ(run.losses.count(what), 1u);
    EXPECT_GE(run.losses.at(what).count, 1u);
}

TEST(RayPlan, LongBuildingCanBeInterrupted)
{
    World const world = world_of(box_with_block_and_lamp());
    Camera const camera = look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70);
    Report report;
    RenderSettings s = small_settings(8, 4, 2);
    s.of<SlhbSettings>().schedule = Schedule::stored;
    s.of<SlhbSettings>().resolution = 64;
    StopAtAsk while_time_stands(1, {});
    EXPECT_EQ(render_as_set(world, camera, s, while_time_stands, {}, report).paths, 1u) << "a picture to keep";
    StopAtAsk after_long(while_time_stands.asks() / 4);
    EXPECT_THROW(render_as_set(world, camera, s, after_long, {}, report), Interrupted);
    EXPECT_LE(after_long.asks(), while_time_stands.asks() / 4 + asks_until_noticed());
}

} // namespace
} // namespace gi::test
