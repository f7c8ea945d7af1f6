// What the plan of slhb chooses between look-ups and exact rays, and that its choice is right where look-ups were
// not.

#include "gi/methods/reference/reference.h"
#include "gi/methods/slhb/hit_buffer/look_up_trust.h"
#include "gi/methods/slhb/settings.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/stop_at_ask.h"

namespace gi::test {
namespace {

/// A room of 4 m with an open side, on a plane of `reach` m to each side, under a sky.
Scene room_on_a_plane(float reach)
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.6f}));
    add_quad(scene, {-reach, -0.01f, reach}, {2 * reach, 0, 0}, {0, 0, -2 * reach}, wall);
    add_quad(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, wall); // floor
    add_quad(scene, {-2, 3, -2}, {4, 0, 0}, {0, 0, 4}, wall); // ceiling
    add_quad(scene, {-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, wall); // back
    add_quad(scene, {-2, 0, 2}, {0, 0, -4}, {0, 3, 0}, wall); // left
    add_quad(scene, {2, 0, -2}, {0, 0, 4}, {0, 3, 0}, wall);  // right
    add_box(scene, {-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}, wall, false);
    set_environment(scene, vec3{1});
    return scene;
}
Camera const kInRoom = look_at({0.5, 1.6, 1.5}, {-0.3, 0.8, -1}, 70);

double agreement(World const& world, Camera const& camera, std::uint32_t resolution)
{
    return look_up_agreement(world, make_soup(world), camera_rays(camera, 48, 48, world.origin), resolution);
}

TEST(RayPlan, LookUpsAreNotTrustedInARoomOfALargeWorld)
{
    EXPECT_LT(agreement(world_of(room_on_a_plane(5000)), kInRoom, 256), 0.5);
    EXPECT_LT(agreement(world_of(room_on_a_plane(50)), kInRoom, 64), 0.8);
    // Objects between texel centres: no column has them, and all agree about what lies beyond.
    Scene village;
    int const ground = add_material(village, lambert(vec3{0.5f}));
    add_quad(village, {-5000, 0, 5000}, {10000, 0, 0}, {0, 0, -10000}, ground);
    for (int k = 0; k < 25; ++k) {
        vec3 const at{float(k % 5) * 30 - 60, 0, float(k / 5) * -30};
        add_box(village, at, at + vec3{8, 6, 8}, ground, false);
    }
    EXPECT_LT(agreement(world_of(std::move(village)), look_at({0, 10, 40}, {0, 2, -60}, 60), 256), 0.8);
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
        Picture const seen = render_with_slhb(world, kInRoom, s).result.picture;
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
        for (LookUps const l : {LookUps::all, LookUps::none}) {
            s.slhb.look_ups = l;
            EXPECT_NEAR(mean_of(render_with_slhb(world, camera, s).result.picture).mean, truth, 0.01 * truth)
                << bounces << " bounces, look-ups " << int(l);
        }
    }
}

TEST(RayPlan, DoesWhatIsAskedFor)
{
    World const world = world_of(room_on_a_plane(5000));
    TriangleSoup const soup = make_soup(world);
    RenderSettings asked = small_settings(64, 16, 3);
    SlhbSettings s = choose_settings(asked, world, soup, kInRoom);
    EXPECT_EQ(s.look_ups, LookUps::none);
    EXPECT_EQ(s.shadows, Shadows::rays);
    EXPECT_EQ(s.roulette, 0);
    asked.budget_s = 1;
    EXPECT_GT(choose_settings(asked, world, soup, kInRoom).roulette, 0);
    asked.slhb.schedule = Schedule::streamed;
    s = choose_settings(asked, world, soup, kInRoom);
    EXPECT_EQ(s.look_ups, LookUps::all);
    EXPECT_EQ(s.shadows, Shadows::maps);
    asked.slhb.shadows = Shadows::rays;
    EXPECT_EQ(choose_settings(asked, world, soup, kInRoom).shadows, Shadows::rays);
}

TEST(RayPlan, BuffersStayWithinTheirMemory)
{
    World const world = world_of(box_with_block_and_lamp());
    RenderSettings s = small_settings(8, 4, 2);
    s.slhb.schedule = Schedule::stored;
    s.slhb.resolution = 256;
    s.slhb.memory_mib = 64; // 160 axes of 256 x 256 take about 500
    SlhbRun const run = render_with_slhb(world, look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70), s);
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
    s.slhb.schedule = Schedule::stored;
    s.slhb.resolution = 64;
    StopAtAsk while_time_stands(1, {});
    EXPECT_EQ(render_slhb(world, camera, s, while_time_stands, {}, report).paths, 1u) << "a picture to keep";
    StopAtAsk after_long(while_time_stands.asks() / 4);
    EXPECT_THROW(render_slhb(world, camera, s, after_long, {}, report), Interrupted);
    EXPECT_LE(after_long.asks(), while_time_stands.asks() / 4 + asks_until_noticed());
}

} // namespace
} // namespace gi::test
