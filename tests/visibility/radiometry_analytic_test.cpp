// Exact visibility of virtual lights gives what the reference gives; the others lie where their definitions say.

#include "tests/visibility/visibility_render.h"

#include <fmt/format.h>

namespace gi::test {
namespace {

/// Within 0.5 %, and within 3.5 sigma.
void expect_mean(RunningMean const& m, double truth, std::string const& what, double tolerance = 0.005)
{
    EXPECT_LE(std::abs(m.mean() - truth), tolerance * std::abs(truth))
        << what << ": " << m.mean() << " for " << truth;
    EXPECT_LE(std::abs(m.mean() - truth), 3.5 * m.sigma() + 2e-6 * std::abs(truth))
        << what << ": " << m.mean() << " for " << truth << ", sigma " << m.sigma();
}

TEST(VisibilityFurnace, RoomOfGlowingWallsHasTheRadianceOfItsSeries)
{
    // A closed room whose walls emit E and reflect rho everywhere shows E / (1 - rho).
    for (float const rho : {0.3f, 0.8f}) {
        Scene scene;
        Material wall = lambert(vec3{rho});
        wall.emission = vec3{0.5f};
        add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, wall), true);
        World const world = world_of(scene);
        RenderSettings s = small_picture(12, 24, 1000);
        s.of<VirtualLightSettings>().light_paths = 256;
        RunningMean const m =
            mean_over_seeds(VisibilityKind::exact, world, look_at({0.3, 0.1, 0.2}, {-1, -0.5, -0.7}, 70), s, 12);
        expect_mean(m, 0.5 / (1 - double(rho)), fmt::format("albedo {}", rho));
    }
}

TEST(VisibilityFurnace, NothingHidesAnythingInAConvexRoom)
{
    // So no visibility at all is right there, and so are hit buffers and maps of points, nearly.
    Scene scene;
    Material wall = lambert(vec3{0.5f});
    wall.emission = vec3{0.5f};
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, wall), true);
    World const world = world_of(scene);
    Camera const eye = look_at({0.3, 0.1, 0.2}, {-1, -0.5, -0.7}, 70);
    RenderSettings const s = small_picture(16, 32, 1000);
    expect_mean(mean_over_seeds(VisibilityKind::none, world, eye, s, 16), 1.0, "none");
    double const exact = mean_of(render_visibility(VisibilityKind::exact, world, eye, s).result.picture).mean;
    for (VisibilityKind const kind : {VisibilityKind::slhb, VisibilityKind::imperfect})
        EXPECT_NEAR(mean_of(render_visibility(kind, world, eye, s).result.picture).mean, exact, 0.01 * exact)
            << int(kind);
}

/// Parallel light from below on a plate, which lights a small surface that lies under its middle.
struct Plates {
    World world;
    Camera camera = orthographic({0, 0.3, 0}, {0, 0, 0}, 0.01);
    double form_factor; ///< from the small surface to the plate

    Plates()
    {
        constexpr float h = 1, a = 0.5f;
        Scene scene;
        add_quad(scene, {-a, h, -a}, {2 * a, 0, 0}, {0, 0, 2 * a}, add_material(scene, lambert(vec3{0.8f})));
        add_quad(scene, {-0.01f, 0, 0.01f}, {0.02f, 0, 0}, {0, 0, -0.02f},
                 add_material(scene, lambert(vec3{0.5f})));
        Light light;
        light.type = LightType::directional;
        light.direction = {0, 1, 0};
        light.intensity = vec3{kPi};
        add_light(scene, light);
        world = world_of(scene);
        // Differential surface to a parallel rectangle with a corner above it (Howell, B-3), four times.
        double const x = a / h, b = std::sqrt(1 + x * x);
        form_factor = 4 * 2 * x / b * std::atan(x / b) / (2 * glm::pi<double>());
    }
};

TEST(VisibilityFormFactor, PlateAboveASmallSurface)
{
    // Irradiance pi on the plate: radiance 0.8 back; the small surface sends 0.5 * F * 0.8 on. The light that
    // travels upwards passes the floor piece from below, which shadows 0.04 % of the plate.
    Plates const plates;
    double const truth = 0.5 * 0.8 * plates.form_factor;
    for (VisibilityKind const kind : {VisibilityKind::exact, VisibilityKind::none, VisibilityKind::directional})
        expect_mean(mean_over_seeds(kind, plates.world, plates.camera, small_picture(4, 64, 1), 24, "L2"), truth,
                    fmt::format("kind {}", int(kind)), 0.007);
}

TEST(VisibilityCornell, ExactIsTheReferenceForAnyNumberOfBounces)
{
    World const world = world_of(box_with_block());
    for (int const bounces : {0, 1, 3}) {
        RunningMean const truth =
            reference_over_seeds(world, in_the_box(), small_picture(16, 256, bounces), 8, "L2");
        RunningMean const m =
            mean_over_seeds(VisibilityKind::exact, world, in_the_box(), small_picture(16, 24, bounces), 24, "L2");
        double const sigma = std::hypot(m.sigma(), truth.sigma());
        EXPECT_NEAR(m.mean(), truth.mean(), 3.5 * sigma + 1e-9) << bounces << " bounces";
        if (bounces > 0) {
            EXPECT_LT(sigma, 0.01 * truth.mean()) << "the test sees little";
        }
    }
}

TEST(VisibilityCornell, WhatIsNearComesFromCameraPathsWithoutABias)
{
    World const world = world_of(box_with_block());
    RunningMean few, many;
    RenderSettings s = small_picture(16, 24, 2);
    s.of<VirtualLightSettings>().near_m = 0.01f;
    few = mean_over_seeds(VisibilityKind::exact, world, in_the_box(), s, 16, "L2");
    s.of<VirtualLightSettings>().near_m = 1.5f;
    many = mean_over_seeds(VisibilityKind::exact, world, in_the_box(), s, 16, "L2");
    EXPECT_NEAR(few.mean(), many.mean(), 3.5 * std::hypot(few.sigma(), many.sigma()));
    EXPECT_LT(std::hypot(few.sigma(), many.sigma()), 0.015 * few.mean());
}

TEST(VisibilityCornell, EveryLampLightsTheSceneAsInTheReference)
{
    auto const box = [](Scene& scene) {
        add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.7f})));
        add_quad(scene, {-1, 0, -1}, {2, 0, 0}, {0, 1.5f, 0},
                 add_material(scene, lambert(vec3{0.5f, 0.6f, 0.7f})));
        add_box(scene, {-0.3f, 0, -0.3f}, {0.3f, 0.5f, 0.1f}, add_material(scene, lambert(vec3{0.6f})), false);
    };
    std::vector<std::pair<std::string, Scene>> scenes(6);
    for (auto& [name, scene] : scenes) box(scene);
    Light light;
    light.position = {0.5f, 1.2f, 0.6f};
    light.intensity = vec3{2, 1, 0.5f};
    scenes[0].first = "point";
    add_light(scenes[0].second, light);
    light.type = LightType::spot;
    light.direction = glm::normalize(vec3{-0.4f, -1, -0.8f});
    light.cos_inner = 0.95f;
    light.cos_outer = 0.8f;
    light.range = 2;
    scenes[1].first = "spot with a range";
    add_light(scenes[1].second, light);
    light.type = LightType::directional;
    scenes[2].first = "parallel light";
    add_light(scenes[2].second, light);
    scenes[3].first = "sky";
    set_environment(scenes[3].second, vec3{0.5f, 0.7f, 1});
    scenes[4].first = "lamp with two sides";
    add_quad(scenes[4].second, {-0.2f, 1, 0.3f}, {0.4f, 0, 0}, {0, 0.1f, 0.4f},
             add_material(scenes[4].second, emitter(vec3{4}, true)));
    scenes[5].first = "sky and lamp";
    set_environment(scenes[5].second, vec3{0.3f});
    add_quad(scenes[5].second, {-0.2f, 1, 0.3f}, {0.4f, 0, 0}, {0, 0, 0.4f},
             add_material(scenes[5].second, emitter(vec3{4})));
    Camera const eye = look_at({1, 1.2, 1.8}, {0, 0.3, -0.2}, 45);
    for (auto const& [name, scene] : scenes) {
        World const world = world_of(scene);
        for (char const* const layer : {"L1", "L2"}) {
            RunningMean const truth = reference_over_seeds(world, eye, small_picture(16, 256, 2), 8, layer);
            RunningMean const m =
                mean_over_seeds(VisibilityKind::exact, world, eye, small_picture(16, 32, 2), 16, layer);
            double const sigma = std::hypot(m.sigma(), truth.sigma());
            EXPECT_NEAR(m.mean(), truth.mean(), 3.5 * sigma) << name << ", " << layer;
            EXPECT_LT(sigma, 0.03 * truth.mean()) << name << ", " << layer << ": the test sees little";
        }
    }
}

TEST(VisibilityCornell, MaterialsOfAllKindsAreThoseOfTheReference)
{
    // Mirrors and glass are walked through by both ends of the paths; glossy surfaces receive and send.
    Material plastic = lambert(vec3{0.3f, 0.5f, 0.3f});
    plastic.specular = 1;
    plastic.roughness = 0.4f;
    Material phong = lambert(vec3{0.3f});
    phong.model = MaterialModel::phong;
    phong.phong_specular = vec3{0.4f};
    phong.phong_exponent = 8;
    std::pair<char const*, Material> const cases[] = {
        {"mirror", mirror(vec3{0.9f})}, {"glass", glass(1.5f, false)}, {"plastic", plastic}, {"phong", phong}};
    for (auto const& [name, material] : cases) {
        Scene scene;
        add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.6f})), true);
        add_sphere(scene, {-0.2f, -0.4f, -0.1f}, 0.5f, 3, add_material(scene, material), true);
        add_quad(scene, {-0.5f, 0.99f, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{5})));
        World const world = world_of(scene);
        Picture const truth = reference_picture(world, in_the_box(), small_picture(12, 2048, 2));
        RunningMean const m =
            mean_over_seeds(VisibilityKind::exact, world, in_the_box(), small_picture(12, 16, 2), 12);
        double const sigma = std::hypot(m.sigma(), mean_of(truth).sigma), mean = mean_of(truth).mean;
        EXPECT_NEAR(m.mean(), mean, 3.5 * sigma) << name;
        EXPECT_LT(sigma, 0.015 * mean) << name << ": the test sees little";
    }
}

} // namespace
} // namespace gi::test
