// Pictures of the method ispm: furnaces, convergence as photons grow, and splatting against the photon map.

#include "gi/light_paths/light_paths.h"
#include "gi/light_paths/settings.h"
#include "gi/methods/photons/methods.h"
#include "gi/methods/photons/splat_light.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// Mean and mean difference of L2, over what it must be, in a closed thing that glows evenly (radiance 1, albedo a
/// half: L2 is a half).
std::pair<double, double> furnace(bool sphere, RenderSettings s)
{
    Scene scene;
    Material m = emitter(vec3{1}, true);
    m.base_color = vec3{0.5f};
    int const wall = add_material(scene, m);
    if (sphere)
        add_sphere(scene, vec3{0}, 1, 5, wall, false);
    else
        add_box(scene, {-1, -1, -1}, {1, 1, 1}, wall, true);
    s.width = s.height = 32;
    Report report;
    Picture const p =
        render_ispm(world_of(scene), look_at({0, 0, 0.3}, {0, -0.2, -1}, 90), s, {}, {}, report).picture;
    double mean = 0, off = 0;
    std::vector<float> const& values = p.find("L2")->data;
    for (float const v : values) {
        mean += 2 * double(v) / double(values.size());
        off += std::abs(2 * double(v) - 1) / double(values.size());
    }
    return {mean, off};
}

/// Kernels that reach beyond the edges of a box lose no light.
TEST(Ispm, Furnace)
{
    for (KernelBy const by : {KernelBy::density, KernelBy::footprint})
        for (bool const sphere : {false, true}) {
            RenderSettings s;
            s.paths = 8;
            s.of<PhotonSettings>().kernel_by = by;
            auto const [mean, off] = furnace(sphere, s);
            fmt::print("{}, kernels by {}: mean {:.4f}, off by {:.4f}\n", sphere ? "sphere" : "box",
                       by == KernelBy::density ? "density" : "footprint", mean, off);
            EXPECT_NEAR(mean, 1, 0.01);
            EXPECT_LT(off, 0.07);
        }
}

/// As photons grow, noise and blur fall together, with a power of -1/3 (the mean squared error, -2/3):
/// away from edges and at them.
TEST(Ispm, ConvergesWithPhotons)
{
    for (bool const sphere : {true, false}) {
        double first = 0, last = 0;
        for (int k = 0; k < 3; ++k) {
            RenderSettings s;
            s.paths = 1;
            s.of<PhotonSettings>().paths = 4096 << 3 * k;
            double const off = furnace(sphere, s).second;
            fmt::print("{}: {} light paths, off by {:.4f}\n", sphere ? "sphere" : "box", s.of<PhotonSettings>().paths, off);
            (k == 0 ? first : last) = off;
        }
        double const slope = std::log2(last / first) / 6;
        fmt::print("{}: slope {:.3f}\n", sphere ? "sphere" : "box", slope);
        EXPECT_LT(slope, -0.25);
    }
}

/// Points on a screen get the same light from its lists as from a search in the photon map, wherever it looks
/// from, and from the map alone if there are no lists.
TEST(Ispm, SplattingIsThePhotonMap)
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.7f}));
    Material shiny = lambert(vec3{0.4f});
    shiny.roughness = 0.4f;
    shiny.specular = 1;
    int const floor = add_material(scene, shiny);
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, wall, true);
    add_box(scene, {-0.4f, -1, -0.4f}, {0.4f, -0.5f, 0.4f}, floor, false);
    Light lamp;
    lamp.position = {0, 0.8f, 0};
    lamp.intensity = vec3{1};
    add_light(scene, lamp);
    World const world = world_of(scene);
    ExactVisibility const visibility(world, false, 0);
    LightPaths paths;
    paths.count = 20000;
    paths.bounces = 4;
    PathCounts counts;
    std::vector<Photon> photons;
    for (LightVertex const& v :
         trace_light_paths(view(world), world.bounds, ExactPathRays(visibility), paths, counts))
        photons.push_back(to_photon(v));
    sort_along_curve(photons);
    std::vector<float> const radii = radii_by_density(photons, 0.2f, 16, 1);
    PhotonMap const map(photons, radii);
    std::vector<PhotonKernel> kernels;
    for (std::uint32_t i = 0; i < photons.size(); ++i)
        kernels.push_back({photons[i].position, radii[i], photons[i].normal, i});
    View<Photon const> const all{photons.data(), photons.size()};
    View<PhotonKernel const> const near{kernels.data(), kernels.size()};

    Camera skewed = look_at({0.1, 0.3, 0.9}, {0, -0.7, 0}, 80);
    skewed.off_axis = ViewTangents{-0.5, 1.2, -1, 0.4};
    Camera const cameras[] = {look_at({0.1, 0.3, 0.9}, {0, -0.7, 0}, 80), skewed,
                              look_at({-0.99, -0.99, 0.99}, {0, 0, 0}, 100),
                              orthographic({0, 0.9, 0}, {0, 0, 0}, 1.5)};
    for (Camera const& camera : cameras) {
        FrameView const eye{camera, 70, 50};
        std::vector<PhotonTiles> const screens = tiles_of_views({&eye, 1}, world.origin, near, all);
        ASSERT_EQ(screens.size(), 1u);
        CameraRays const rays = camera_rays(camera, eye.width, eye.height, world.origin);
        std::vector<TreePoint> points;
        std::vector<vec3> expected;
        for (int y = 0; y < eye.height; ++y)
            for (int x = 0; x < eye.width; ++x) {
                RayQuery const q{.ray = rays.through({float(x) + 0.5f, float(y) + 0.5f})};
                Hit hit;
                visibility.nearest({&q, 1}, {&hit, 1});
                if (hit.triangle == kNoTriangle) continue;
                TreePoint p{.at = shading_point(view(world), hit.triangle, hit.barycentric, q.ray.direction),
                            .wo = {},
                            .rng = Pcg32(1, 1),
                            .direct = true,
                            .glossy_traced = x % 7 == 0,
                            .scatterings = 0,
                            .throughput = vec3{1},
                            .sample = nullptr};
                p.wo = p.at.frame.to_local(-q.ray.direction);
                ASSERT_EQ(screens[0].view().screen.pixel_of(p.at.position), (glm::ivec2{x, y}));
                points.push_back(p);
                expected.push_back(map.radiance(p.at, p.wo, p.glossy_traced));
            }
        ASSERT_GT(points.size(), 3000u);
        for (bool const lists : {true, false}) {
            std::vector<vec3> found(points.size());
            std::vector<PhotonTiles> const none;
            SplatLight(lists ? screens : none, map, nullptr).indirect(points, found, counts);
            double sum = 0;
            for (std::size_t k = 0; k < found.size(); ++k) {
                ASSERT_LT(glm::length(found[k] - expected[k]), 1e-3f * max_component(expected[k]) + 1e-6f);
                sum += double(found[k].x);
            }
            EXPECT_GT(sum / double(found.size()), 0.01);
        }
    }
}

/// Lists of more than 2^32 entries are counted, not made; of kernels about the camera's
/// plane only those count that can be seen.
TEST(Ispm, ListsTooLongForMemory)
{
    Camera const camera = look_at({0, 0, 0}, {0, 0, -1}, 60);
    FrameView const eye{camera, 16384, 16384};
    std::size_t const tiles = 1024 * 1024;
    std::vector<PhotonKernel> kernels(5000, {{0, 0, -0.5f}, 1, {0, 0, 1}, 0});
    std::vector<Photon> const photons(1);
    auto const all = [&] { return View<PhotonKernel const>{kernels.data(), kernels.size()}; };
    ScreenMap const screen = screen_map(eye, dvec3{0});
    EXPECT_EQ(tile_entries(screen, all()), kernels.size() * tiles);
    EXPECT_GT(tile_entries(screen, all()), std::uint64_t(1) << 32);
    EXPECT_TRUE(tiles_of_views({&eye, 1}, dvec3{0}, all(), {photons.data(), photons.size()}).empty());
    for (PhotonKernel& k : kernels) k.position = {-3, 0, 0}; // beside the camera
    EXPECT_EQ(tile_entries(screen, all()), 0u);
    EXPECT_EQ(tiles_of_views({&eye, 1}, dvec3{0}, all(), {photons.data(), photons.size()}).size(), 1u);
}

} // namespace
} // namespace gi::test
