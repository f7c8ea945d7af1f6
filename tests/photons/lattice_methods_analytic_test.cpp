// Pictures of the methods lpv and isllpm against closed forms and the reference.

#include "gi/methods/photons/methods.h"
#include "gi/methods/reference/reference.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

using Render = RenderResult (*)(World const&, Camera const&, RenderSettings const&, StopRequest const&,
                                RenderProgress const&, Report&);

RenderSettings small_picture(int size)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = 4;
    return s;
}

double mean_of_layer(Picture const& p, char const* layer)
{
    double sum = 0;
    std::vector<float> const& data = p.find(layer)->data;
    for (float const v : data) sum += double(v) / double(data.size());
    return sum;
}

/// Inside of something closed that glows evenly, light of two and more scatterings is albedo^2 / (1 - albedo):
/// with an albedo of a half, a half.
TEST(LatticeMethods, Furnace)
{
    for (bool const round : {false, true})
        for (bool const propagates : {false, true}) {
            Scene scene;
            Material glowing = emitter(vec3{1}, true);
            glowing.base_color = vec3{0.5f};
            int const wall = add_material(scene, glowing);
            if (round)
                add_sphere(scene, vec3{0}, 1, 4, wall, false);
            else
                add_box(scene, {-1, -1, -1}, {1, 1, 1}, wall, true);
            Render const render = propagates ? render_lpv : render_isllpm;
            Report report;
            Picture const p =
                render(world_of(scene), look_at({0, 0, 0.3}, {0, -0.2, -1}, 90), small_picture(32), {}, {}, report)
                    .picture;
            double off = 0;
            for (float const v : p.find("L2")->data)
                off += std::abs(2 * double(v) - 1) / double(p.find("L2")->data.size());
            double const mean = 2 * mean_of_layer(p, "L2");
            fmt::print("{}, {}: mean {:.4f}, off by {:.4f}\n", propagates ? "lpv" : "isllpm",
                       round ? "sphere" : "box", mean, off);
            // Surfaces that are not along the lattice let light of lpv through, and block it twice: half is lost.
            EXPECT_NEAR(mean, 1, !propagates ? 0.01 : round ? 0.5 : 0.1);
            EXPECT_LT(off, !propagates ? 0.1 : round ? 0.5 : 0.1);
        }
}

/// A glossy floor before a lit wall: its lobe takes light from the lattices.
TEST(LatticeMethods, GlossyFloor)
{
    Scene scene;
    Material floor = lambert(vec3{0.2f});
    floor.metallic = 1;
    floor.base_color = vec3{0.7f};
    floor.roughness = 0.6f;
    floor.specular = 1;
    add_box(scene, {-2, 0, -2}, {2, 3, 2}, add_material(scene, lambert(vec3{0.6f})), true);
    add_quad(scene, {-1.9f, 0.05f, -1.9f}, {0, 0, 3.8f}, {3.8f, 0, 0}, add_material(scene, floor));
    add_quad(scene, {-0.5f, 2.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{8})));
    World const world = world_of(scene);
    Camera const camera = look_at({0, 1.5, 1.8}, {0, 0, -0.5}, 60);
    Report report;
    RenderSettings s = small_picture(32);
    s.paths = 100;
    double const truth = mean_of_layer(render_reference(world, camera, s, {}, {}, report).picture, "L2");
    s.paths = 4;
    for (bool const propagates : {false, true}) {
        Render const render = propagates ? render_lpv : render_isllpm;
        double const found = mean_of_layer(render(world, camera, s, {}, {}, report).picture, "L2");
        fmt::print("{}: {:.3f} of the reference\n", propagates ? "lpv" : "isllpm", found / truth);
        EXPECT_NEAR(found / truth, 1, propagates ? 0.35 : 0.15);
    }
}

TEST(LatticeMethods, ScenesWithoutLightOrSurfaces)
{
    for (Render const render : {render_lpv, render_isllpm})
        for (int kind = 0; kind < 3; ++kind) {
            Scene scene;
            if (kind > 0) {
                add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, lambert(vec3{0.5f})));
                scene.meshes.back().triangles.resize(1);
            }
            if (kind == 2)
                add_quad(scene, {1e6f, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, emitter(vec3{1})));
            Report report;
            Picture const p =
                render(world_of(scene), look_at({0, 0, 3}, {0, 0, 0}, 60), small_picture(8), {}, {}, report)
                    .picture;
            EXPECT_EQ(mean_of_layer(p, "L2"), 0);
        }
}

} // namespace
} // namespace gi::test
