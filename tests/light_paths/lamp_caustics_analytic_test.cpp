// Light of lamps without extent by way of mirrors and refracting glass, in pictures by paths from the camera.

#include "gi/light_paths/settings.h"
#include "gi/methods/registry.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

constexpr double kFloor = 0.5, kIntensity = 10;

Scene lit_floor(vec3 lamp)
{
    Scene scene;
    Light light;
    light.intensity = vec3{float(kIntensity)};
    light.position = lamp;
    add_light(scene, light);
    add_quad(scene, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, add_material(scene, lambert(vec3{float(kFloor)})));
    return scene;
}

constexpr double kWindow_m = 0.8;

/// Mean radiance of a square of the floor by light that scatters once, each of whose points has its own photons.
double floor_at(std::string const& method, World const& world, dvec3 at, int photons = 16384)
{
    RenderSettings s;
    s.width = s.height = 16;
    s.paths = 48;
    s.bounces = 0;
    s.of<PhotonSettings>().caustic_paths = photons;
    Report report;
    Camera const camera = orthographic(at + dvec3{0, 0.02, 0}, at, kWindow_m);
    return mean_of(find_method(method).render(world, camera, s, {}, {}, report).picture, "L1").mean;
}

/// Its closed form. @param radiance  of a point of the floor
template <class Radiance>
double mean_over_window(dvec3 at, Radiance const& radiance)
{
    constexpr int kPoints = 64;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i)
        for (int k = 0; k < kPoints; ++k)
            sum += radiance(at + kWindow_m * dvec3{(i + 0.5) / kPoints - 0.5, 0, (k + 0.5) / kPoints - 0.5});
    return sum / (kPoints * kPoints);
}

double direct(dvec3 lamp, dvec3 at)
{
    dvec3 const way = lamp - at;
    return kFloor / glm::pi<double>() * kIntensity * way.y / std::pow(glm::length(way), 3);
}

class LampCausticsOf : public testing::TestWithParam<char const*> {};

TEST_P(LampCausticsOf, AMirrorAreThoseOfTheLampsImage)
{
    dvec3 const lamp{-1, 1, 0}, image{1, 1, 0}, at{-0.6, 0, 0.3};
    Scene scene = lit_floor(vec3(lamp));
    add_quad(scene, {0, 0.001f, 4}, {0, 4, 0}, {0, 0, -8}, add_material(scene, mirror(vec3{0.8f})));
    auto const seen = [&](dvec3 place) { return direct(lamp, place); };
    double const all = mean_over_window(at, [&](dvec3 place) {
        double const cosine = (image - place).x / glm::length(image - place);
        return seen(place) + (0.8 + 0.2 * std::pow(1 - cosine, 5)) * direct(image, place); // Schlick
    });
    World const world = world_of(scene);
    EXPECT_NEAR(floor_at(GetParam(), world, at), all, 0.01 * all);
    double const without = mean_over_window(at, seen); // --caustic-photons 0
    EXPECT_NEAR(floor_at(GetParam(), world, at, 0), without, 0.003 * without);
}

/// A clear ball around a lamp: what a face reflects leaves on the other side, as if there were no ball.
TEST_P(LampCausticsOf, ABulbAreTheLampsOwnLight)
{
    dvec3 const lamp{0, 1, 0}, at{0.1, 0, 0.05};
    Scene scene = lit_floor(vec3(lamp));
    add_sphere(scene, vec3(lamp), 0.2f, 4, add_material(scene, glass(1.5f, false)), true);
    double const all = mean_over_window(at, [&](dvec3 place) { return direct(lamp, place); });
    EXPECT_NEAR(floor_at(GetParam(), world_of(scene), at), all, 0.01 * all);
}

/// Panes are left to shadow rays: their light counts once.
TEST_P(LampCausticsOf, APaneHaveOnlyWhatItReflects)
{
    dvec3 const lamp{0, 2, 0}, at{0.3, 0, 0.1};
    Scene scene = lit_floor(vec3(lamp));
    add_quad(scene, {-5, 1, 5}, {10, 0, 0}, {0, 0, -10}, add_material(scene, glass(1.5f, true)));
    double const all = mean_over_window(at, [&](dvec3 place) {
        double const cosine = 2 / glm::length(lamp - place), c = std::sqrt(1 - (1 - cosine * cosine) / 2.25);
        double const s = (cosine - 1.5 * c) / (cosine + 1.5 * c), p = (c - 1.5 * cosine) / (c + 1.5 * cosine);
        double const r = 0.5 * (s * s + p * p);
        return (1 - r) / (1 + r) * direct(lamp, place);
    });
    EXPECT_NEAR(floor_at(GetParam(), world_of(scene), at), all, 0.003 * all);
}

INSTANTIATE_TEST_SUITE_P(Methods, LampCausticsOf, testing::Values("reference", "paths", "slhb"));

TEST(LampCaustics, AreCountedWhereTheyAreNotFound)
{
    Scene scene = lit_floor({0, 1, 0});
    add_sphere(scene, {0, 1, 0}, 0.2f, 2, add_material(scene, glass(1.5f, false)), true);
    World const world = world_of(scene);
    for (char const* const method : {"reference", "paths", "slhb", "whitted", "vpl_exact", "ispm", "lpv"}) {
        RenderSettings s;
        s.width = s.height = 4;
        s.paths = 1;
        Report report;
        find_method(method).render(world, orthographic({0, 0.5, 0}, {0, 0, 0}, 0.1), s, {}, {}, report);
        std::string const name = method;
        bool const finds = name == "reference" || name == "paths" || name == "slhb" || name == "ispm";
        EXPECT_EQ(report.losses().count("lamps whose light by way of mirrors and glass was not found"), !finds)
            << name;
    }
}

} // namespace
} // namespace gi::test
