// The method slhb on the analytic ladder: within 0.5 % of closed forms. Its error is correlated over the picture
// (all pixels share axes and lamps), so that the variance of pixels says nothing about the mean.

#include "gi/hit_buffers/settings.h"
#include "tests/slhb/slhb_render.h"

#include <fmt/format.h>

namespace gi::test {
namespace {

void expect_mean(Picture const& picture, double truth, std::string const& what, double tolerance = 0.005)
{
    EXPECT_NEAR(mean_of(picture).mean, truth, tolerance * truth) << what;
}

TEST(SlhbFurnace, SphereUnderAUniformSky)
{
    for (float const albedo : {0.5f, 1.0f}) {
        Scene scene;
        add_sphere(scene, vec3{0}, 1, 3, add_material(scene, lambert(vec3{albedo})), false);
        set_environment(scene, vec3{1});
        World const world = world_of(scene);
        for (int const bounces : {0, 3, 64}) {
            RenderSettings s = small_settings(12, 256, bounces);
            s.of<SlhbSettings>().shadow_resolution = 128;
            s.of<SlhbSettings>().resolution = 64;
            expect_mean(render_small(world, orthographic({0, 0, 5}, {0, 0, 0}, 1.2), s).result.picture, albedo,
                        fmt::format("albedo {}, {} bounces", albedo, bounces));
        }
    }
}

TEST(SlhbFurnace, ClosedSphereThatGlows)
{
    // Inside a sphere all form factors are equal, so there is little noise.
    // The result holds for every closed uniform surface, however few its triangles are.
    for (float const rho : {0.5f, 0.9f}) {
        Scene scene;
        Material wall = lambert(vec3{rho});
        wall.emission = vec3{0.5f};
        wall.double_sided = true;
        add_sphere(scene, vec3{0}, 1, 3, add_material(scene, wall), false);
        World const world = world_of(scene);
        for (int const bounces : {0, 32}) {
            RenderSettings s = small_settings(8, 256, bounces);
            s.of<SlhbSettings>().shadow_resolution = 128;
            s.of<SlhbSettings>().resolution = 64;
            s.of<SlhbSettings>().axes = 8;
            s.of<SlhbSettings>().light_samples = 8;
            // E (1 + rho + ... + rho^(bounces + 1))
            double const truth = 0.5 * (1 - std::pow(double(rho), bounces + 2)) / (1 - double(rho));
            expect_mean(render_small(world, look_at({0.1, 0.2, 0.1}, {-1, -0.5, -0.7}, 90), s).result.picture,
                        truth, fmt::format("albedo {}, {} bounces", rho, bounces));
        }
    }
}

TEST(SlhbFurnace, SchedulesAgree)
{
    World const world = world_of(box_with_block_and_lamp());
    Camera const camera = look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70);
    RenderSettings s = small_settings(16, 512, 3);
    double const streamed = mean_of(render_small(world, camera, s).result.picture, "L2").mean;
    for (Schedule const other : {Schedule::stored, Schedule::temporal}) {
        s.of<SlhbSettings>().schedule = other;
        EXPECT_NEAR(mean_of(render_small(world, camera, s).result.picture, "L2").mean, streamed,
                    0.01 * streamed);
    }
    s.of<SlhbSettings>().schedule = Schedule::stored;
    s.of<SlhbSettings>().directions = "icosahedron:80";
    s.paths = 400; // ten times all 40 axes
    double const stored = mean_of(render_small(world, camera, s).result.picture, "L2").mean;
    s.of<SlhbSettings>().gather = true;
    EXPECT_NEAR(mean_of(render_small(world, camera, s).result.picture, "L2").mean, stored, 0.01 * stored);
}

TEST(SlhbFurnace, InterleavingTakesEveryPixelInTurn)
{
    // As many passes as turns: every pixel has had its indirect light once.
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.6f})), true);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
    World const world = world_of(scene);
    for (int const n : {2, 3, 5, 10}) {
        RenderSettings s = small_settings(20, std::uint32_t(n * n), 1);
        s.of<PathsSettings>().interleave = n;
        s.of<SlhbSettings>().resolution = 16;
        s.of<SlhbSettings>().shadow_resolution = 32;
        Picture const picture =
            render_small(world, look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70), s).result.picture;
        std::size_t dark = 0;
        std::vector<float> const& indirect = picture.find("L2")->data;
        for (std::size_t p = 0; p < indirect.size(); p += 3) dark += indirect[p] == 0;
        EXPECT_LT(dark, indirect.size() / 3 * 2 / 5) << n; // a walk may end where no lamp is seen
    }
}

TEST(SlhbRadiometry, PointAndParallelLight)
{
    for (LightType const type : {LightType::point, LightType::directional}) {
        Scene scene;
        add_quad(scene, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, add_material(scene, lambert(vec3{0.5f})));
        Light light;
        light.type = type;
        light.position = {0, 2, 0};
        light.direction = {0, -1, 0};
        light.intensity = vec3{3};
        add_light(scene, light);
        World const world = world_of(scene);
        double const irradiance = type == LightType::point ? 3.0 / 4 : 3.0;
        expect_mean(render_small(world, orthographic({0, 1, 0}, {0, 0, 0}, 0.02), small_settings(8, 16, 2))
                        .result.picture,
                    0.5 / M_PI * irradiance, "light");
    }
}

TEST(SlhbRadiometry, FormFactorOfParallelSquares)
{
    // Irradiance at the middle of a square from an equal one above at distance a:
    // F = 4 / (2 pi) * ... (Howell C-11).
    Scene scene;
    add_quad(scene, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, add_material(scene, lambert(vec3{0.5f})));
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, add_material(scene, emitter(vec3{1})));
    World const world = world_of(scene);
    double const h = 1 / std::sqrt(2.0), factor = 4 * (2 * h * std::atan(h)) / (2 * M_PI);
    RenderSettings s = small_settings(8, 512, 0);
    expect_mean(render_small(world, orthographic({0, 0.5, 0}, {0, 0, 0}, 0.02), s).result.picture,
                0.5 * factor, "square");
}

TEST(SlhbFurnace, MirrorsAndGlassPassTheFieldOn)
{
    for (Material const& material : {mirror(vec3{1}), glass(1.5f, false), glass(1.5f, true)}) {
        Scene scene;
        add_sphere(scene, vec3{0}, 1, 3, add_material(scene, material), false);
        set_environment(scene, vec3{1});
        expect_mean(
            render_small(world_of(scene), orthographic({0, 0, 5}, {0, 0, 0}, 1.2), small_settings(12, 64, 64))
                .result.picture,
            1, "lossless");
    }
}

} // namespace
} // namespace gi::test
