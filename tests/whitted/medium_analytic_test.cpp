// Light inside of coloured glass, by all methods.

#include "gi/core/error.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/registry.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

constexpr vec3 kAbsorption{0.5f, 1, 2}; // 1/m
constexpr float kThickness_m = 0.5f;

/// Glass that does not reflect.
Material liquid()
{
    Material m = glass(1, false);
    m.absorption = kAbsorption;
    return m;
}

/// A slab under a white sky. @param lamp_m  depth of a glowing square in it, 0 = none
World slab(float lamp_m)
{
    Scene scene;
    add_box(scene, {-1, -1, -kThickness_m}, {1, 1, 0}, add_material(scene, liquid()), false);
    if (lamp_m > 0)
        add_quad(scene, {-0.9f, -0.9f, -lamp_m}, {1.8f, 0, 0}, {0, 1.8f, 0},
                 add_material(scene, emitter(vec3{1}, true)));
    set_environment(scene, vec3{1});
    return world_of(std::move(scene));
}

/// From so far that all rays are nearly parallel.
Camera eye() { return look_at({0, 0, 60}, {0, 0, 0}, 1); }

RenderSettings few_paths()
{
    RenderSettings s;
    s.width = s.height = 8;
    s.paths = 8;
    return s;
}

void expect_left(Picture const& picture, float way_m, std::string const& what)
{
    Layer const& color = *picture.find("color");
    for (std::size_t i = 0; i < picture.pixels(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(color.data[3 * i + c], std::exp(-kAbsorption[int(c)] * way_m), 2e-3f)
                << what << ", pixel " << i << ", channel " << c;
}

TEST(Medium, LetsTheShareOfItsThicknessThrough)
{
    Report report;
    for (float const lamp_m : {0.0f, 0.2f}) {
        World const world = slab(lamp_m);
        float const way_m = lamp_m > 0 ? lamp_m : kThickness_m;
        for (std::string const& name : lamp_m > 0 ? std::vector<std::string>{"reference", "paths", "slhb", "whitted"}
                                                  : method_names()) {
            Method const& m = find_method(name);
            expect_left(m.render(world, eye(), few_paths(), {}, {}, report).picture, way_m, name);
        }
        Picture const p = render_paths_by_kernels(Space::host, world, eye(), few_paths(), {}, {}, report).picture;
        expect_left(p, way_m, "paths by kernels");
    }
}

/// Glass beside what does not absorb, and light that has been scattered inside.
TEST(Medium, EndsWhereThePathLeavesIt)
{
    Report report;
    Scene scene;
    int const inner = add_material(scene, glass(1, false));
    add_box(scene, {-1, -1, -kThickness_m}, {1, 1, 0}, add_material(scene, liquid()), false);
    add_box(scene, {-1, -1, -2}, {1, 1, -1}, inner, false);
    add_quad(scene, {-0.9f, -0.9f, -3}, {1.8f, 0, 0}, {0, 1.8f, 0}, add_material(scene, lambert(vec3{1})));
    set_environment(scene, vec3{1});
    World const world = world_of(std::move(scene));
    RenderSettings s = few_paths();
    s.paths = 2000;
    s.bounces = 64;
    // The square is white, and lit by what comes around the slabs and through them: at most 1.
    Picture const by_reference = find_method("reference").render(world, eye(), s, {}, {}, report).picture;
    Picture const by_paths = find_method("paths").render(world, eye(), s, {}, {}, report).picture;
    Estimate const a = mean_of(by_reference), b = mean_of(by_paths);
    EXPECT_LT(a.mean, (std::exp(-0.25) + std::exp(-0.5) + std::exp(-1.0)) / 3);
    EXPECT_GT(a.mean, 0.3);
    EXPECT_NEAR(a.mean, b.mean, 0.01 * a.mean + 3 * (a.sigma + b.sigma));
}

/// Light of a lamp that reaches a floor through a slab, by light paths.
TEST(Medium, AbsorbsLightOfLamps)
{
    Report report;
    std::array<Picture, 2> lit;
    for (bool const absorbs : {false, true}) {
        Scene scene;
        add_box(scene, {-1, -1, -kThickness_m}, {1, 1, 0}, add_material(scene, absorbs ? liquid() : glass(1, false)),
                false);
        add_quad(scene, {-0.2f, -0.2f, -1.5f}, {0.4f, 0, 0}, {0, 0.4f, 0}, add_material(scene, lambert(vec3{1})));
        Light lamp;
        lamp.position = {0, 0, 4};
        lamp.intensity = vec3{10};
        add_light(scene, lamp);
        RenderSettings s = few_paths();
        s.bounces = 0;
        Camera const below = look_at({0, -0.6, -1}, {0, 0, -1.5}, 10);
        lit[absorbs] = find_method("reference").render(world_of(std::move(scene)), below, s, {}, {}, report).picture;
    }
    std::array<vec3, 2> sums{};
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t i = 0; i < lit[k].pixels(); ++i) sums[k] += rgb(*lit[k].find("L1"), i);
    ASSERT_GT(sums[0].x, 0);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sums[1][c] / sums[0][c], std::exp(-kAbsorption[c] * kThickness_m), 0.02f);
}

TEST(Medium, IsReadAsItsColourAtADistance)
{
    vec3 const a = absorption({0.5f, 1, 0}, 2);
    EXPECT_NEAR(a.x, std::log(2.0f) / 2, 1e-6f);
    EXPECT_EQ(a.y, 0);
    EXPECT_EQ(a.z, 1e9f) << "finite";
    EXPECT_EQ(std::exp(-a.z * 0.0f), 1);
}

} // namespace
} // namespace gi::test
