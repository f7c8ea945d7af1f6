// Nested windows: their layers are exact whatever lies beside them, they follow cameras, and light in a room of a large
// world is right by look-ups alone.

#include "gi/hit_buffers/windows.h"

#include "gi/hit_buffers/hit_buffer.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/reference/reference.h"
#include "tests/raster/plain_raster.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/closed_mesh.h"

namespace gi::test {
namespace {

/// Sees a window of the mesh's bounds, a part of their size.
RasterGrid random_window(World const& world, Pcg32& rng, float part)
{
    vec3 const half = 0.5f * part * (world.bounds.high - world.bounds.low);
    vec3 const at = world.positions[rng.next() % world.positions.size()];
    vec3 const axis = random_direction(rng);
    vec2 const jitter = rng.uniform2();
    return make_window({at - half, at + half}, world.bounds, axis, 32, jitter, 2 * kPi * rng.uniform());
}

TEST(Windows, ClosedMeshesHaveNeitherHolesNorDoublesInThem)
{
    Pcg32 rng(7, 0);
    for (int mesh = 0; mesh < 60; ++mesh) {
        World const world = random_closed_mesh(rng, mesh % 4, 1.5f);
        TriangleSoup const soup = make_soup(world);
        RasterGrid const grid = random_window(world, rng, std::pow(10.0f, -4 * rng.uniform()));
        EXPECT_GE(grid.subpixels, 2);
        HitBuffer const b = make_hit_buffer(soup, grid);
        Fragments plain;
        rasterize_plain(soup, 0, soup.count, grid, MacroPath::edge_table, plain);
        HitBuffer expected;
        fill_hit_buffer(plain, grid, 0, expected);
        ASSERT_EQ(b.offset, expected.offset);
        for (std::size_t t = 0; t < grid.texels(); ++t) {
            int inside = 0;
            for (std::uint32_t k = b.offset[t]; k < b.offset[t + 1]; ++k) {
                ASSERT_EQ(b.layers[k].primitive, expected.layers[k].primitive);
                ASSERT_NEAR(b.layers[k].depth, expected.layers[k].depth, 1e-5f * world.bounds.radius());
                inside += (b.layers[k].primitive & kAlongAxis) != 0 ? 1 : -1;
            }
            ASSERT_EQ(inside, 0) << "mesh " << mesh << ", texel " << t;
        }
    }
}

TEST(Windows, LieWithinEachOther)
{
    Bounds const whole{{-100, -1, -100}, {100, 20, 100}}, room{{0, 0, 0}, {5, 3, 6}};
    std::vector<Bounds> const boxes = nested_windows(whole, room, 256, 0);
    ASSERT_EQ(boxes.size(), 2u);
    Bounds outer = whole;
    for (Bounds const& b : boxes) {
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(b.low, outer.low)) &&
                    glm::all(glm::lessThanEqual(b.high, outer.high)));
        outer = b;
    }
    EXPECT_TRUE(glm::all(glm::lessThanEqual(outer.low, room.low)) &&
                glm::all(glm::greaterThanEqual(outer.high, room.high)));
    EXPECT_EQ(nested_windows(whole, room, 256, 2).size(), 1u);
    EXPECT_TRUE(nested_windows(whole, room, 256, 1).empty()) << "one level is that of the whole";
    EXPECT_TRUE(nested_windows(whole, {}, 256, 0).empty()) << "nothing is near";
    EXPECT_TRUE(nested_windows(room, room, 256, 0).empty()) << "the whole is as large";
    Bounds const planet{vec3{-1e7f}, vec3{1e7f}};
    std::vector<Bounds> const deep = nested_windows(planet, {vec3{0}, vec3{1e-3f}}, 1024, 0);
    ASSERT_EQ(deep.size(), kMostLevels - 1);
    EXPECT_GE(make_window(deep.back(), planet, glm::normalize(vec3{1, 1, 1}), 1024, {0, 0}, 0.8f).subpixels, 2);
}

TEST(Windows, FollowCamerasThatLeaveThem)
{
    World const world = world_of(room_on_a_plane(500));
    TriangleSoup const soup = make_soup(world);
    SlhbSettings settings;
    settings.resolution = 256;
    Windows windows(settings);
    auto const follow = [&](Camera const& camera) {
        CameraRays const rays = camera_rays(camera, 32, 32, world.origin);
        return windows.follow(world.bounds, soup, {&rays, 1});
    };
    EXPECT_TRUE(follow(kInRoom));
    ASSERT_FALSE(windows.boxes().empty());
    EXPECT_FALSE(follow(look_at({-0.8, 1, -1}, {1, 1, 1}, 70))) << "in the same room";
    EXPECT_TRUE(follow(look_at({300, 2, 100}, {0, 1, 0}, 70)));
    EXPECT_FALSE(follow(look_at({300, 2, 100}, {900, 1, 0}, 70))) << "only turned";
    EXPECT_FALSE(follow(look_at({300, 2.1, 101}, {900, 1, 0}, 70))) << "a step";
    follow(look_at({0, 2000, 0}, {0, 9000, 1}, 70)); // nothing but the plane far below
    EXPECT_FALSE(follow(look_at({0, 2001, 0}, {0, 9000, 1}, 70)));
    EXPECT_TRUE(follow(kInRoom));
    Camera above = kInRoom;
    above.orthographic = true;
    EXPECT_TRUE(follow(above));
    EXPECT_TRUE(windows.boxes().empty()) << "orthographic cameras see all at one size";
}

TEST(Windows, ARoomInALargeWorldHasItsLightByLookUpsAlone)
{
    World const world = world_of(room_on_a_plane(500));
    RenderSettings s = small_settings(24, 64, 3);
    s.of<SlhbSettings>().resolution = 256;
    s.of<SlhbSettings>().shadow_resolution = 512;
    StopRequest stop;
    Report report;
    auto const light = [&](int levels, Confirming confirm) {
        RenderSettings by = with(kSlhb, s);
        by.of<SlhbSettings>().levels = levels;
        by.of<SlhbSettings>().confirm = confirm;
        return mean_of(render_by("slhb", world, kInRoom, by, stop, {}, report).picture).mean;
    };
    double const nested = light(0, Confirming::off), one = light(1, Confirming::off),
                 confirmed = light(0, Confirming::on);
    double const kernels =
        mean_of(render_by_kernels(Space::host, world, kInRoom, with(kSlhb, s), stop, {}, report).picture).mean;
    s.paths = 256;
    double const truth = mean_of(render_reference(world, kInRoom, s, stop, {}, report).picture).mean;
    std::cout << confirmed / truth << " of the light, without exact rays " << nested / truth
              << ", and by one level " << one / truth << "\n";
    EXPECT_NEAR(confirmed, truth, 0.01 * truth);
    EXPECT_NEAR(nested, truth, 0.02 * truth);
    EXPECT_GT(std::abs(one - truth), 0.1 * truth);
    EXPECT_NEAR(kernels, confirmed, 0.01 * truth);
}

} // namespace
} // namespace gi::test
