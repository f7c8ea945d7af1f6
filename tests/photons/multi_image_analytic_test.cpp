// Pictures of the method multi_image: furnaces, light by a mirror in closed form, hard cases.

#include "gi/light_paths/settings.h"
#include "gi/methods/photons/methods.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// In a closed thing that glows evenly (radiance 1, albedo a half) L2 is a half.
TEST(MultiImage, Furnace)
{
    for (bool const sphere : {false, true})
        for (ImpostorSearch const search : {ImpostorSearch::walk, ImpostorSearch::cascaded}) {
            Scene scene;
            Material m = emitter(vec3{1}, true);
            m.base_color = vec3{0.5f};
            int const wall = add_material(scene, m);
            if (sphere)
                add_sphere(scene, vec3{0}, 1, 5, wall, false);
            else
                add_box(scene, {-1, -1, -1}, {1, 1, 1}, wall, true);
            RenderSettings s;
            s.width = s.height = 48;
            s.paths = 4;
            s.of<PhotonSettings>().paths = 65536;
            s.of<PhotonSettings>().volume_cells = 16;
            s.of<PhotonSettings>().impostor_search = search;
            Report report;
            Picture const p =
                render_multi_image(world_of(scene), look_at({0, 0, 0.3}, {0, -0.2, -1}, 90), s, {}, {}, report)
                    .picture;
            double mean = 0, off = 0;
            std::vector<float> const& values = p.find("L2")->data;
            for (float const v : values) {
                mean += 2 * double(v) / double(values.size());
                off += std::abs(2 * double(v) - 1) / double(values.size());
            }
            fmt::print("{}, search {}: mean {:.4f}, off by {:.4f}\n", sphere ? "sphere" : "box", int(search), mean,
                       off);
            EXPECT_NEAR(mean, 1, search == ImpostorSearch::walk ? 0.02 : 0.1);
            EXPECT_LT(off, 0.12);
        }
}

/// A lamp beside a mirror: the floor gets the light of the lamp and of its image.
TEST(MultiImage, LightByAMirror)
{
    Scene scene;
    int const floor = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, floor);
    add_quad(scene, {1, 0, -2}, {0, 0, 4}, {0, 2, 0}, add_material(scene, mirror(vec3{1})));
    Light lamp;
    lamp.position = {0, 1, 0};
    lamp.intensity = vec3{kPi};
    add_light(scene, lamp);
    World const world = world_of(scene);
    double truth = 0;
    constexpr int kSteps = 64;
    for (int k = 0; k < kSteps * kSteps; ++k) {
        double const x = 0.4 * (k % kSteps + 0.5) / kSteps - 0.2, z = 0.4 * (k / kSteps + 0.5) / kSteps - 0.2;
        for (double const from : {0.0, 2.0}) { // cos / d^2, from a height of 1
            double const squared = (x - from) * (x - from) + 1 + z * z;
            truth += 0.5 / (squared * std::sqrt(squared)) / (kSteps * kSteps);
        }
    }
    RenderSettings s;
    s.width = s.height = 32;
    s.paths = 4;
    s.bounces = 1;
    s.of<PhotonSettings>().caustic_paths = 262144;
    // 0.4 m of the floor, from 4 m above; in front of it the lamp is no surface.
    Camera const above = look_at({0, 4, 0.001}, {0, 0, 0}, 2 * std::atan(0.05) * 180 / kPiD);
    Report report;
    Picture const p = render_multi_image(world, above, s, {}, {}, report).picture;
    EXPECT_NEAR(mean_of(p).mean / truth, 1, 0.02);
    EXPECT_GT(report.counts().at("flux of caustics on screen, W (luminance)"), 0);
    // Without a screen the photon map serves.
    Report of_map;
    Picture const q =
        render_multi_image(world, orthographic({0, 4, 0.001}, {0, 0, 0}, 0.4), s, {}, {}, of_map).picture;
    EXPECT_NEAR(mean_of(q).mean / truth, 1, 0.02);
    EXPECT_EQ(of_map.counts().at("flux of caustics on screen, W (luminance)"), 0);
}

} // namespace
} // namespace gi::test
