// The screen-space light gathering volume: light is kept, and stays on its surface.

#include "gi/core/rng.h"
#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.h"
#include "gi/methods/photons/lattice_kernels.h"
#include "gi/methods/photons/screen_volume.h"
#include "tests/support/on_device.h"
#include "tests/support/scenes.h"

namespace gi::test {
namespace {

Photon photon_at(vec3 position, vec3 normal, vec3 from, vec3 flux)
{
    Photon p{};
    p.position = position;
    p.normal = normal;
    p.from = glm::normalize(from);
    p.flux = flux;
    p.by_delta = true;
    return p;
}

ScreenVolume volume_of(World const& world, Camera const& camera, int width, int height,
                       ScreenVolumeSettings const& settings = {})
{
    ScreenVolume volume(settings);
    volume.place(world, make_soup(world), CutOuts(world), {.camera = camera, .width = width, .height = height});
    return volume;
}

/// Sum over pixels of irradiance at their surfaces times area, W.
dvec3 flux_on_screen(ScreenVolume const& volume)
{
    ScreenVolumeView const v = volume.view();
    dvec3 sum{0};
    for (int y = 0; y < v.screen.size.y; ++y)
        for (int x = 0; x < v.screen.size.x; ++x) {
            ScreenSurface const& s = v.surfaces[std::size_t(y * v.screen.size.x + x)];
            if (s.area > 0) sum += dvec3(s.area * v.irradiance({x, y}, s.normal));
        }
    return sum;
}

World floor_world()
{
    Scene scene;
    add_quad(scene, {-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, add_material(scene, lambert(vec3{0.5f})));
    return world_of(scene);
}

Camera const kAbove = look_at({0, 2.5, 2}, {0, 0, 0}, 50);

std::vector<Photon> even_photons(std::size_t n, float side, vec3 flux)
{
    Pcg32 rng(8, 8);
    std::vector<Photon> photons;
    for (std::size_t k = 0; k < n; ++k) {
        vec2 const u = side * (rng.uniform2() - 0.5f);
        photons.push_back(
            photon_at({u.x, 0, u.y}, {0, 1, 0}, {0.5f - rng.uniform(), 1, rng.uniform() - 0.5f}, flux));
    }
    return photons;
}

TEST(ScreenVolume, ShowsTheAreaOfSurfaces)
{
    // A floor piece that is seen whole: its pixels' areas add up to its own.
    Scene scene;
    add_quad(scene, {-0.8f, 0, -0.6f}, {0, 0, 1.2f}, {1.6f, 0, 0}, add_material(scene, lambert(vec3{0.5f})));
    ScreenVolume const volume = volume_of(world_of(scene), kAbove, 320, 240);
    double area = 0;
    for (ScreenSurface const& s : volume.view().surfaces) {
        area += double(s.area);
        if (s.area > 0) {
            EXPECT_NEAR(s.position.y, 0, 1e-4);
            EXPECT_NEAR(s.normal.y, 1, 1e-5);
        }
    }
    EXPECT_NEAR(area, 1.92, 0.02);
}

TEST(ScreenVolume, KeepsTheFluxOfAFlatFloor)
{
    World const world = floor_world();
    std::vector<Photon> const photons = even_photons(20000, 1, {2, 1, 0.5f});
    for (int const gathers : {0, 1, 8, 40}) {
        ScreenVolume volume = volume_of(world, kAbove, 160, 120, {.gathers = gathers});
        volume.update(photons);
        EXPECT_EQ(volume.lost_w(), dvec3{0});
        EXPECT_NEAR(volume.injected_w().x, 40000, 1);
        dvec3 const flux = flux_on_screen(volume);
        EXPECT_NEAR(flux.x / 40000, 1, 0.002) << gathers;
        EXPECT_NEAR(flux.y / 20000, 1, 0.002) << gathers;
        EXPECT_NEAR(flux.z / 10000, 1, 0.002) << gathers;
    }
}

TEST(ScreenVolume, GivesTheIrradianceOfEvenLight)
{
    World const world = floor_world();
    ScreenVolume volume = volume_of(world, kAbove, 80, 60, {.gathers = 16});
    constexpr float kSide = 2, kFlux = 0.001f;
    volume.update(even_photons(200000, kSide, vec3{kFlux}));
    float const truth = 200000 * kFlux / (kSide * kSide);
    double sum = 0;
    int n = 0;
    for (float x = -0.5f; x <= 0.5f; x += 0.1f)
        for (float z = -0.5f; z <= 0.5f; z += 0.1f, ++n) {
            vec3 out;
            ASSERT_TRUE(volume.view().irradiance_at({x, 0, z}, {0, 1, 0}, {0, 1, 0}, out));
            sum += double(out.y);
            EXPECT_NEAR(out.y, truth, 0.15f * truth);
        }
    EXPECT_NEAR(sum / n, double(truth), 0.02 * double(truth));
    vec3 out;
    EXPECT_FALSE(volume.view().irradiance_at({0, 0.5f, 0}, {0, 1, 0}, {0, 1, 0}, out));
    EXPECT_FALSE(volume.view().irradiance_at({0, 0, 0}, {0, -1, 0}, {0, -1, 0}, out));
    EXPECT_FALSE(volume.view().irradiance_at({0, 5, 4}, {0, 1, 0}, {0, 1, 0}, out)); // behind the camera
}

TEST(ScreenVolume, KnowsWhereLightComesFrom)
{
    World const world = floor_world();
    ScreenVolume volume = volume_of(world, kAbove, 80, 60);
    std::vector<Photon> photons;
    for (int k = 0; k < 1000; ++k) photons.push_back(photon_at({0, 0, 0}, {0, 1, 0}, {1, 1, 0}, vec3{1}));
    volume.update(photons);
    vec3 level, towards, away;
    ASSERT_TRUE(volume.view().irradiance_at({0, 0, 0}, {0, 1, 0}, {0, 1, 0}, level));
    ASSERT_TRUE(volume.view().irradiance_at({0, 0, 0}, {0, 1, 0}, glm::normalize(vec3{1, 1, 0}), towards));
    ASSERT_TRUE(volume.view().irradiance_at({0, 0, 0}, {0, 1, 0}, glm::normalize(vec3{-1, 1, 0}), away));
    EXPECT_GT(level.x, 0);
    EXPECT_NEAR(towards.x / level.x, 0.75 / (0.25 + 0.5 * std::sqrt(0.5)), 1e-3); // to degree 1
    EXPECT_NEAR(away.x / level.x, 0.25 / (0.25 + 0.5 * std::sqrt(0.5)), 1e-3);
}

TEST(ScreenVolume, LightCrossesNoEdgeOfDepth)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, matt);
    add_quad(scene, {-0.4f, 0.5f, -0.4f}, {0, 0, 0.8f}, {0.8f, 0, 0}, matt); // a table top, of the same normal
    World const world = world_of(scene);
    std::vector<Photon> photons;
    Pcg32 rng(9, 9);
    for (int k = 0; k < 5000; ++k) {
        vec2 const u = 0.8f * (rng.uniform2() - 0.5f);
        photons.push_back(photon_at({u.x, 0.5f, u.y}, {0, 1, 0}, {0, 1, 0}, vec3{1}));
        // Below the table, where the camera does not see it.
        photons.push_back(photon_at({0.1f * u.x, 0, 0.1f * u.y - 0.4f}, {0, 1, 0}, {0, 1, 0}, vec3{100}));
    }
    ScreenVolume volume = volume_of(world, kAbove, 160, 120, {.gathers = 50});
    volume.update(photons);
    EXPECT_NEAR(volume.injected_w().x, 5000, 5);
    EXPECT_NEAR(volume.lost_w().x, 500000, 5);
    double by_height[2] = {0, 0};
    ScreenVolumeView const v = volume.view();
    for (std::size_t k = 0; k < v.surfaces.size(); ++k)
        by_height[v.surfaces[k].position.y > 0.25f ? 1 : 0] += double(v.light[k].integral().x);
    EXPECT_NEAR(by_height[0], 0, 1e-3);
    EXPECT_NEAR(by_height[1], 5000, 10);
}

TEST(ScreenVolume, HoldsNothingWithoutPhotonsOrSurfaces)
{
    ScreenVolume volume = volume_of(floor_world(), kAbove, 16, 12);
    volume.update({});
    EXPECT_EQ(flux_on_screen(volume), dvec3{0});
    vec3 out{1};
    EXPECT_TRUE(volume.view().irradiance_at({0, 0, 0}, {0, 1, 0}, {0, 1, 0}, out));
    EXPECT_EQ(out, vec3{0});
    ScreenVolume nothing = volume_of(world_of(Scene{}), kAbove, 16, 12);
    nothing.update(even_photons(10, 1, vec3{1}));
    EXPECT_EQ(nothing.injected_w(), dvec3{0});
    EXPECT_NEAR(nothing.lost_w().x, 10, 1e-5);
    EXPECT_FALSE(nothing.view().irradiance_at({0, 0, 0}, {0, 1, 0}, {0, 1, 0}, out));
    std::vector<Photon> bad = even_photons(1, 1, vec3{std::nanf("")});
    volume.update(bad);
    EXPECT_EQ(flux_on_screen(volume), dvec3{0});
}

template <Space S>
void check_kernels()
{
    ScreenVolume host = volume_of(floor_world(), kAbove, 60, 40, {.gathers = 3});
    std::vector<Photon> const photons = even_photons(3000, 1, vec3{1});
    host.update(photons);
    ScreenVolumeView const v = host.view();
    std::size_t const pixels = v.surfaces.size();
    auto const surfaces = upload<S>(std::vector(v.surfaces.begin(), v.surfaces.end()));
    auto const there = upload<S>(photons);
    Buffer<ScreenPhoton, S> items(photons.size());
    Buffer<std::uint64_t, S> keys(photons.size());
    launch(S, "find pixels of photons", photons.size(),
           FindPhotonPixels{v.screen, surfaces.view(), there.view(), items.view(), keys.view()});
    std::vector<std::uint64_t> found = download(keys);
    ItemsByCell const sorted = sort_by_cell(found, pixels);
    auto const order = upload<S>(sorted.order), firsts = upload<S>(sorted.firsts);
    Buffer<ShColor, S> light = upload<S>(std::vector<ShColor>(pixels)), next(pixels);
    launch(
        S, "inject into pixels", pixels,
        SumItems<ScreenPhoton, ShColor>{std::as_const(items).view(), order.view(), firsts.view(), light.view()});
    for (int step = 0; step < 3; ++step) {
        launch(S, "gather on screen", pixels,
               GatherScreen{v.screen.size, surfaces.view(), std::as_const(light).view(), next.view()});
        std::swap(light, next);
    }
    std::vector<ShColor> const out = download(light);
    for (std::size_t k = 0; k < pixels; ++k)
        for (int c = 0; c < 4; ++c)
            ASSERT_NEAR(out[k].c[c].x, v.light[k].c[c].x, 1e-4f * (1 + std::abs(v.light[k].c[c].x))) << k;
}
LIGHTWELL_TEST_BOTH(ScreenVolumeKernels, GiveTheSame, check_kernels);

} // namespace
} // namespace gi::test
