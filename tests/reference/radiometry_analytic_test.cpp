// Closed forms of radiometry: lamps over planes, form factors, energy balance of closed rooms.

#include "gi/methods/reference/reference.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

RenderResult render_square(World const& world, Camera const& camera, int size, std::uint32_t paths,
                           int bounces = 0)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = paths;
    s.bounces = bounces;
    s.seed = 11;
    StopRequest stop;
    Report report;
    return render_reference(world, camera, s, stop, {}, report);
}

/// Irradiance at `point` with normal `n` from a polygon of radiance L (Lambert 1760): L / 2 * sum of the angles
/// that the edges subtend times the cosine between n and their planes.
double polygon_irradiance(std::vector<dvec3> const& corners, dvec3 point, dvec3 n, double radiance)
{
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        dvec3 const a = glm::normalize(corners[i] - point);
        dvec3 const b = glm::normalize(corners[(i + 1) % corners.size()] - point);
        sum += std::acos(glm::dot(a, b)) * glm::dot(n, glm::normalize(glm::cross(a, b)));
    }
    return std::abs(0.5 * radiance * sum);
}

constexpr float kAlbedo = 0.6f;

/// A floor seen from below the lamps through a tiny orthographic window around `at`.
Estimate floor_radiance(Scene scene, dvec3 at)
{
    add_quad(scene, {-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, add_material(scene, lambert(vec3{kAlbedo})));
    return mean_of(render_square(world_of(scene), orthographic(at + dvec3{0, 0.1, 0}, at, 1e-3), 8, 16384).picture,
                   "L1");
}

TEST(Radiometry, RectangleLightIrradiance)
{
    for (dvec3 const at : {dvec3{0, 0, 0}, dvec3{1.5, 0, 0.5}, dvec3{-3, 0, 2}}) {
        Scene scene;
        vec3 const corner{-0.5f, 1, -0.3f}, u{1, 0, 0}, v{0, 0, 0.6f};
        add_quad(scene, corner, u, v, add_material(scene, emitter(vec3{4}))); // faces down
        double const irradiance = polygon_irradiance(
            {dvec3(corner), dvec3(corner + u), dvec3(corner + u + v), dvec3(corner + v)}, at, {0, 1, 0}, 4);
        expect_estimate(floor_radiance(scene, at), kAlbedo / glm::pi<double>() * irradiance, "rectangle");
    }
}

/// What is cut out of a lamp does not shine, whichever technique finds it.
TEST(Radiometry, LampWithHoles)
{
    vec3 const corner{-0.5f, 1, -0.3f}, u{1, 0, 0}, v{0, 0, 0.6f};
    double const irradiance = polygon_irradiance(
        {dvec3(corner), dvec3(corner + u), dvec3(corner + u + v), dvec3(corner + v)}, {0, 0, 0}, {0, 1, 0}, 4);
    for (float const alpha : {0.25f, 0.75f}) {
        Scene scene;
        Material lamp = emitter(vec3{4});
        lamp.alpha_mode = AlphaMode::blend;
        lamp.alpha = alpha;
        add_quad(scene, corner, u, v, add_material(scene, lamp));
        expect_estimate(floor_radiance(scene, {0, 0, 0}), double(alpha) * kAlbedo / glm::pi<double>() * irradiance,
                        fmt::format("alpha {}", alpha));
    }
    for (bool const of_vertices : {false, true}) {
        Scene scene;
        Material lamp = emitter(vec3{4});
        lamp.alpha_mode = AlphaMode::mask;
        lamp.alpha = of_vertices ? 1 : 0.25f;
        add_quad(scene, corner, u, v, add_material(scene, lamp));
        if (of_vertices) scene.meshes.back().alphas.assign(4, 0.25f);
        EXPECT_EQ(floor_radiance(scene, {0, 0, 0}).mean, 0);
    }
    Scene scene; // half of what the material leaves
    Material lamp = emitter(vec3{4});
    lamp.alpha_mode = AlphaMode::blend;
    lamp.alpha = 0.5f;
    add_quad(scene, corner, u, v, add_material(scene, lamp));
    scene.meshes.back().alphas.assign(4, 0.5f);
    expect_estimate(floor_radiance(scene, {0, 0, 0}), 0.25 * kAlbedo / glm::pi<double>() * irradiance,
                    "alphas of vertices");
}

TEST(Radiometry, OneSidedLampIsDarkFromBehind)
{
    Scene scene;
    add_quad(scene, {-0.5f, 1, -0.3f}, {0, 0, 0.6f}, {1, 0, 0}, add_material(scene, emitter(vec3{4}))); // faces up
    EXPECT_EQ(floor_radiance(scene, {0, 0, 0}).mean, 0);
}

TEST(Radiometry, PointSpotAndDirectionalLight)
{
    dvec3 const at{0.7, 0, -0.4};
    dvec3 const lamp{-0.2, 1.5, 0.3};
    dvec3 const to = lamp - at;
    double const inverse_square = to.y / std::pow(glm::length(to), 3);

    Light light;
    light.position = vec3(lamp);
    light.intensity = vec3{5};
    Scene point;
    add_light(point, light);
    Estimate e = floor_radiance(point, at);
    e.sigma = std::max(e.sigma, 1e-4 * e.mean);
    expect_estimate(e, kAlbedo / glm::pi<double>() * 5 * inverse_square, "point");

    light.type = LightType::spot;
    light.direction = vec3(glm::normalize(-to));
    light.cos_inner = 0.9f;
    light.cos_outer = 0.8f;
    Scene spot;
    add_light(spot, light);
    e = floor_radiance(spot, at);
    e.sigma = std::max(e.sigma, 1e-4 * e.mean);
    expect_estimate(e, kAlbedo / glm::pi<double>() * 5 * inverse_square, "spot, inside its cone");
    light.direction = {0, 0, -1};
    Scene away;
    add_light(away, light);
    EXPECT_EQ(floor_radiance(away, at).mean, 0);

    light.type = LightType::directional;
    light.direction = glm::normalize(vec3{1, -2, 0.5f});
    Scene sun;
    add_light(sun, light);
    e = floor_radiance(sun, at);
    e.sigma = std::max(e.sigma, 1e-4 * e.mean);
    expect_estimate(e, kAlbedo / glm::pi<double>() * 5 * 2 / std::sqrt(5.25), "directional");
}

TEST(Radiometry, UniformSkyOverFloor)
{
    Scene scene;
    set_environment(scene, vec3{1});
    expect_estimate(floor_radiance(scene, {0, 0, 0}), kAlbedo, "sky");
}

TEST(Radiometry, FormFactorOfParallelSquares)
{
    // Howell, C-11: unit squares at distance 1.
    double const x = 1, y = 1;
    double const factor =
        2 / (glm::pi<double>() * x * y) *
        (0.5 * std::log((1 + x * x) * (1 + y * y) / (1 + x * x + y * y)) +
         x * std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y)) +
         y * std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) - x * std::atan(x) - y * std::atan(y));
    ASSERT_NEAR(factor, 0.19982, 1e-5);
    Scene scene;
    add_quad(scene, {-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{1})));
    add_quad(scene, {-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1}, add_material(scene, lambert(vec3{1})));
    RenderResult const r = render_square(world_of(scene), orthographic({0, 0.5, 0}, {0, 0, 0}, 1), 64, 256);
    expect_estimate(mean_of(r.picture, "L1"), factor, "parallel squares");
}

TEST(Radiometry, FormFactorOfPerpendicularSquares)
{
    // Howell, C-14: two unit squares with a common edge.
    double const root2 = std::sqrt(2.0);
    double const factor =
        (0.5 * glm::pi<double>() - root2 * std::atan(1 / root2) + 0.25 * std::log(0.75)) / glm::pi<double>();
    ASSERT_NEAR(factor, 0.20004, 1e-5);
    Scene scene;
    add_quad(scene, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{1}))); // x = 0, faces +x
    add_quad(scene, {0, 0, 1}, {1, 0, 0}, {0, 0, -1}, add_material(scene, lambert(vec3{1})));
    RenderResult const r =
        render_square(world_of(scene), orthographic({0.5, 0.5, 0.5}, {0.5, 0, 0.5}, 1), 64, 256);
    expect_estimate(mean_of(r.picture, "L1"), factor, "perpendicular squares");
}

TEST(Radiometry, EnergyBalanceOfAClosedRoom)
{
    // All that a lamp of power P emits is absorbed in the end: the flux that leaves the walls after n reflections
    // is P rho^n, whatever the shape of the room. Each wall is seen whole from the opposite one.
    constexpr double kPower = 3;
    for (float const rho : {0.5f, 0.9f}) {
        Scene scene;
        add_box(scene, {0, 0, 0}, {1, 1, 1}, add_material(scene, lambert(vec3{rho})), true);
        Light lamp;
        lamp.position = {0.31f, 0.62f, 0.45f};
        lamp.intensity = vec3{float(kPower / (4 * glm::pi<double>()))};
        add_light(scene, lamp);
        World const world = world_of(scene);
        double direct = 0, all = 0, variance = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (double const side : {-1.0, 1.0}) {
                dvec3 from{0.5};
                dvec3 at{0.5};
                from[axis] = 0.5 - 0.499 * side;
                at[axis] = 0.5 + 0.5 * side;
                RenderResult const r = render_square(world, orthographic(from, at, 1), 32, 128, 1000);
                direct += glm::pi<double>() * mean_of(r.picture, "L1").mean;
                Estimate const e = mean_of(r.picture);
                all += glm::pi<double>() * e.mean;
                variance += square(float(glm::pi<double>() * e.sigma));
            }
        // The lamp is a point: its direct light on a wall is smooth, and pixels average it.
        expect_estimate({direct, std::sqrt(variance)}, kPower * rho, "direct flux");
        expect_estimate({all, std::sqrt(variance)}, kPower * rho / (1 - rho), "all flux");
    }
}

} // namespace
} // namespace gi::test
