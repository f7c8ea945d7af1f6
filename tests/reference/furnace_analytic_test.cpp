// White furnace: in a uniform field of light whatever absorbs nothing cannot be seen.

#include "gi/methods/reference/reference.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

RenderResult render(World const& world, Camera const& camera, int size, std::uint32_t paths, int bounces = 64)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = paths;
    s.bounces = bounces;
    s.seed = 7;
    StopRequest stop;
    Report report;
    RenderResult const r = render_reference(world, camera, s, stop, {}, report);
    EXPECT_EQ(report.losses().count("path terms that were not finite, dropped"), 0u);
    return r;
}

struct Case {
    char const* name;
    Material material;
    double albedo; ///< radiance in a field of 1
};

std::vector<Case> cases()
{
    Material rough_plastic_black = lambert(vec3{0});
    Material phong;
    phong.model = MaterialModel::phong;
    phong.base_color = vec3{0.4f};
    return {{"lambert white", lambert(vec3{1}), 1}, {"lambert grey", lambert(vec3{0.5f}), 0.5},
            {"black", rough_plastic_black, 0},      {"mirror", mirror(vec3{1}), 1},
            {"solid glass", glass(1.5f, false), 1}, {"diamond", glass(2.42f, false), 1},
            {"no glass", glass(1.0f, false), 1},    {"thin sheet", glass(1.5f, true), 1},
            {"phong without lobe", phong, 0.4}};
}

TEST(Furnace, SphereInUniformEnvironment)
{
    for (Case const& c : cases()) {
        Scene scene;
        add_sphere(scene, vec3{0}, 1, 4, add_material(scene, c.material), false);
        set_environment(scene, vec3{1});
        // The view is all inside the silhouette.
        RenderResult const r = render(world_of(scene), orthographic({0, 0, 5}, {0, 0, 0}, 1.2), 16, 1024, 1000);
        Estimate e = mean_of(r.picture);
        // What is exact by construction has no variance but that of rounding.
        e.sigma = std::max(e.sigma, 2e-4 / 3);
        expect_estimate(e, c.albedo, c.name);
    }
}

TEST(Furnace, RoomOfGlowingWalls)
{
    // A closed white room whose walls emit E and reflect rho everywhere shows E / (1 - rho).
    for (float const rho : {0.0f, 0.3f, 0.8f}) {
        Scene scene;
        Material wall = lambert(vec3{rho});
        wall.emission = vec3{0.5f};
        add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, wall), true);
        RenderResult const r =
            render(world_of(scene), look_at({0.3, 0.1, 0.2}, {-1, -0.5, -0.7}, 70), 24, 512, 1000);
        Estimate e = mean_of(r.picture);
        e.sigma = std::max(e.sigma, 1e-6);
        expect_estimate(e, 0.5 / (1 - double(rho)), fmt::format("room with albedo {}", rho));
        if (rho > 0) {
            EXPECT_NEAR(mean_of(r.picture, "L0").mean, 0.5, 1e-5);
            EXPECT_NEAR(mean_of(r.picture, "L1").mean, 0.5 * rho, 0.005 * 0.5 * rho);
            EXPECT_NEAR(mean_of(r.picture, "L2").mean, 0.5 * rho * rho / (1 - rho),
                        0.01 * 0.5 * rho * rho / (1 - rho));
        }
    }
}

/// What a plane under a uniform sky sends towards an eye at `degrees` from its normal.
Estimate plane_under_sky(Material const& material, double degrees)
{
    Scene scene;
    add_quad(scene, {-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, add_material(scene, material));
    set_environment(scene, vec3{1});
    dvec3 const eye{std::sin(glm::radians(degrees)), std::cos(glm::radians(degrees)), 0};
    Estimate e = mean_of(render(world_of(scene), orthographic(eye, {0, 0, 0}, 1e-3), 16, 4096).picture);
    e.sigma = std::max(e.sigma, 2e-4 / 3);
    return e;
}

TEST(Furnace, LobesWithClosedForms)
{
    for (double const degrees : {0.0, 30.0, 60.0, 80.0}) {
        double const schlick = 0.5 + 0.5 * std::pow(1 - std::cos(glm::radians(degrees)), 5);
        expect_estimate(plane_under_sky(mirror(vec3{0.5f}), degrees), schlick,
                        fmt::format("mirror at {}", degrees));
    }
    Material metal = mirror(vec3{1});
    metal.roughness = 1;
    Estimate rough = plane_under_sky(metal, 0);
    rough.sigma = std::max(rough.sigma, 0.003 / 3); // of tables of lobes
    expect_estimate(rough, 1, "rough metal");
    Material phong = lambert(vec3{0.3f});
    phong.model = MaterialModel::phong;
    phong.phong_specular = vec3{0.6f};
    for (float const n : {1.0f, 10.0f, 100.0f}) {
        phong.phong_exponent = n;
        expect_estimate(plane_under_sky(phong, 0), 0.3 + 0.6 * (n + 1) / (n + 2), fmt::format("phong {}", n));
    }
}

TEST(Furnace, ObjectsInARoomThatGlows)
{
    // The field stays uniform whatever lossless objects stand in it.
    for (Case const& c : cases()) {
        if (c.albedo != 1) continue;
        Scene scene;
        add_box(scene, {-2, -2, -2}, {2, 2, 2}, add_material(scene, emitter(vec3{1})), true);
        add_sphere(scene, vec3{0}, 1, 3, add_material(scene, c.material), false);
        RenderResult const r = render(world_of(scene), look_at({0, 0, 1.8}, {0, 0, 0}, 60), 16, 400, 1000);
        Estimate e = mean_of(r.picture);
        e.sigma = std::max(e.sigma, 2e-4 / 3);
        expect_estimate(e, 1, c.name);
    }
}

} // namespace
} // namespace gi::test
