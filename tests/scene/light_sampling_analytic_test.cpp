// Irradiance by light sampling against closed forms, and every density against its twin.

#include "gi/core/rng.h"
#include "gi/scene/shading/light_sampling.h"
#include "tests/support/scenes.h"
#include "tests/support/sphere_chi2.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// Mean of radiance cos / pdf at a point, of the red channel. @param paths independent samples
RunningMean irradiance(World const& world, vec3 point, vec3 normal, std::uint64_t seed, int paths = 500000)
{
    WorldView const v = view(world);
    Pcg32 rng(seed, 0);
    RunningMean mean;
    for (int i = 0; i < paths; ++i) {
        double const u_select = rng.uniform_double();
        LightSample const s = sample_light(v, choose_light(v, u_select), point, rng.uniform2());
        double const cosine = std::max(0.0, double(glm::dot(s.direction, normal)));
        mean.add(s.pdf > 0 ? double(s.radiance.x) * cosine / double(s.pdf) : 0.0);
    }
    return mean;
}

void expect_irradiance(World const& world, vec3 point, vec3 normal, double truth, std::string const& what)
{
    RunningMean const mean = irradiance(world, point, normal, 3001);
    expect_estimate({mean.mean(), mean.sigma()}, truth, what);
}

/// Lambert 1760: a polygon of radiance 1 wholly above the plane; it faces the point.
double polygon_irradiance(std::vector<dvec3> const& corners, dvec3 point, dvec3 normal)
{
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        dvec3 const a = glm::normalize(corners[i] - point);
        dvec3 const b = glm::normalize(corners[(i + 1) % corners.size()] - point);
        sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), normal);
    }
    return 0.5 * std::abs(sum);
}

/// A scene with bounds, but without light of its own.
Scene dark_room()
{
    Scene scene;
    add_box(scene, {-2, -2, -2}, {2, 2, 2}, add_material(scene, lambert(vec3{0.5f})), true);
    return scene;
}

Light punctual(LightType type, vec3 position, vec3 direction, float intensity)
{
    Light light;
    light.type = type;
    light.position = position;
    light.direction = glm::normalize(direction);
    light.intensity = vec3{intensity};
    return light;
}

/// The environment with one texel that is 1.
void set_bright_texel(Scene& scene, std::uint32_t x, std::uint32_t y, float rotation_rad)
{
    set_environment(scene, vec3{0});
    scene.environment->radiance[std::size_t(y) * scene.environment->width + x] = vec3{1};
    scene.environment->rotation_rad = rotation_rad;
    scene.environment->scale = {3, 2, 1};
}

/// Integral of its bilinear radiance times the direction, of the red channel: hat functions of one texel's width,
/// integrated twice by parts. Rows away from the poles.
dvec3 bright_texel_vector(std::uint32_t x, std::uint32_t y, double rotation)
{
    double const du = 2 * kPiD / 16, dv = kPiD / 8, u = (x + 0.5) * du - kPiD, v = (y + 0.5) * dv;
    auto const hat = [](auto const& twice_integrated, double at, double width) {
        return (twice_integrated(at - width) - 2 * twice_integrated(at) + twice_integrated(at + width)) / width;
    };
    double const sin_u = hat([](double t) { return -std::sin(t); }, u, du);
    double const cos_u = hat([](double t) { return -std::cos(t); }, u, du);
    double const sin2_v = hat([](double t) { return 0.25 * t * t + 0.125 * std::cos(2 * t); }, v, dv);
    double const sin_cos_v = hat([](double t) { return -0.125 * std::sin(2 * t); }, v, dv);
    dvec3 const map{sin2_v * sin_u, du * sin_cos_v, -sin2_v * cos_u};
    double const c = std::cos(rotation), s = std::sin(rotation);
    return 3.0 * dvec3{c * map.x + s * map.z, map.y, -s * map.x + c * map.z};
}

TEST(LightSampling, PunctualLights)
{
    vec3 const up{0, 1, 0}, point{0.2f, 0.1f, -0.3f};
    {
        Scene scene = dark_room();
        add_light(scene, punctual(LightType::point, {1, 1.5f, 0.5f}, {0, -1, 0}, 7));
        dvec3 const way = dvec3{1, 1.5, 0.5} - dvec3(point);
        expect_irradiance(world_of(scene), point, up, 7 * way.y / std::pow(glm::length(way), 3), "point");
    }
    {
        Scene scene = dark_room();
        Light light = punctual(LightType::point, {1, 1.5f, 0.5f}, {0, -1, 0}, 7);
        light.range = 2.5f;
        add_light(scene, light);
        dvec3 const way = dvec3{1, 1.5, 0.5} - dvec3(point);
        double const window = 1 - std::pow(glm::length(way) / 2.5, 4);
        expect_irradiance(world_of(scene), point, up, window * 7 * way.y / std::pow(glm::length(way), 3), "range");
        EXPECT_EQ(irradiance(world_of(scene), {-1.9f, -1.9f, -1.9f}, up, 1, 100).mean(), 0) << "beyond the range";
    }
    {
        Scene scene = dark_room();
        add_light(scene, punctual(LightType::directional, {0, 0, 0}, {1, -2, 0.5f}, 3));
        expect_irradiance(world_of(scene), point, up, 3 * 2 / std::sqrt(5.25), "directional");
    }
}

/// KHR_lights_punctual: intensity * saturate((cos - cos_outer) / (cos_inner - cos_outer))^2.
TEST(LightSampling, SpotFallsOffBetweenItsCones)
{
    Scene scene = dark_room();
    Light light = punctual(LightType::spot, {0, 2, 0}, {0, -1, 0}, 5);
    light.cos_inner = float(std::cos(glm::radians(20.0)));
    light.cos_outer = float(std::cos(glm::radians(40.0)));
    add_light(scene, light);
    World const world = world_of(scene);
    for (double const degrees : {0.0, 19.0, 25.0, 30.0, 39.0, 41.0, 90.0}) {
        double const angle = glm::radians(degrees);
        vec3 const point(dvec3{std::sin(angle), 2 - std::cos(angle), 0});
        double const from = std::cos(glm::radians(40.0)), to = std::cos(glm::radians(20.0));
        double const t = glm::clamp((std::cos(angle) - from) / (to - from), 0.0, 1.0);
        // At a distance of 1, on a plane that faces the lamp.
        vec3 const normal(dvec3{-std::sin(angle), std::cos(angle), 0});
        EXPECT_NEAR(irradiance(world, point, normal, 1, 100).mean(), 5 * t * t, 1e-4) << degrees;
    }
}

TEST(LightSampling, TrianglesGiveLambertsIrradiance)
{
    std::vector<dvec3> const corners{{-0.5, 1, -0.3}, {0.9, 1.4, -0.2}, {0.1, 1.2, 0.8}};
    for (bool const double_sided : {false, true}) {
        Scene scene = dark_room();
        Mesh mesh;
        mesh.material = add_material(scene, emitter(vec3{4}, double_sided));
        for (dvec3 const c : corners) mesh.positions.push_back(vec3(c));
        mesh.triangles = {{0, 1, 2}}; // faces down
        Node node;
        node.meshes = {std::int32_t(scene.meshes.size())};
        scene.meshes.push_back(mesh);
        scene.nodes.push_back(node);
        World const world = world_of(scene);
        vec3 const below{0.3f, 0, 0.1f}, above{0.1f, 1.9f, 0.2f};
        expect_irradiance(world, below, {0, 1, 0}, 4 * polygon_irradiance(corners, dvec3(below), {0, 1, 0}),
                          "front");
        double const back = double_sided ? 4 * polygon_irradiance(corners, dvec3(above), {0, -1, 0}) : 0;
        expect_irradiance(world, above, {0, -1, 0}, back, "back");
    }
}

TEST(LightSampling, ConstantEnvironmentGivesPi)
{
    Scene scene = dark_room();
    set_environment(scene, vec3{2});
    World const world = world_of(scene);
    for (vec3 const normal : {vec3{0, 1, 0}, vec3{0, -1, 0}, glm::normalize(vec3{1, 0.3f, -2})})
        expect_irradiance(world, vec3{0}, normal, 2 * kPiD, "constant environment");
}

TEST(LightSampling, OneBrightTexelStandsWhereItShould)
{
    for (float const rotation : {0.0f, 1.0f, -2.5f, 40.0f})
        for (std::uint32_t const x : {0u, 5u, 15u}) {
            Scene scene = dark_room();
            set_bright_texel(scene, x, 2, rotation);
            dvec3 const truth = bright_texel_vector(x, 2, double(rotation));
            // On the side of the texel, and wholly above the plane.
            dvec3 const normal = glm::normalize(glm::normalize(truth) + dvec3{0.1, 0.2, -0.1});
            expect_irradiance(world_of(scene), vec3{0}, vec3(normal), glm::dot(truth, normal), "bright texel");
        }
}

TEST(LightSampling, AllKindsTogetherAddUp)
{
    Scene scene = dark_room();
    vec3 const up{0, 1, 0}, point{0.2f, 0.1f, -0.3f};
    add_light(scene, punctual(LightType::point, {1, 1.5f, 0.5f}, {0, -1, 0}, 7));
    add_light(scene, punctual(LightType::directional, {0, 0, 0}, {1, -2, 0.5f}, 3));
    Light spot = punctual(LightType::spot, {0.2f, 1.1f, -0.3f}, {0, -1, 0}, 2);
    spot.cos_inner = 0.9f;
    spot.cos_outer = 0.8f;
    add_light(scene, spot);
    add_quad(scene, {-0.5f, 1.5f, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(vec3{6})));
    set_environment(scene, vec3{0.5f});
    dvec3 const way = dvec3{1, 1.5, 0.5} - dvec3(point);
    double const quad = polygon_irradiance(
        {{-0.5, 1.5, -0.5}, {0.5, 1.5, -0.5}, {0.5, 1.5, 0.5}, {-0.5, 1.5, 0.5}}, dvec3(point), dvec3(up));
    double const truth =
        7 * way.y / std::pow(glm::length(way), 3) + 3 * 2 / std::sqrt(5.25) + 2 + 6 * quad + 0.5 * kPiD;
    RunningMean const mean = irradiance(world_of(scene), point, up, 3002, 1000000);
    expect_estimate({mean.mean(), mean.sigma()}, truth, "all kinds");
}

TEST(LightSampling, DensitiesAgreeWithWhatPathsAsk)
{
    Scene scene = dark_room();
    std::uint32_t const dark = 12;
    add_quad(scene, {-0.5f, 1.5f, -0.5f}, {1, 0, 0}, {0, 0.2f, 1}, add_material(scene, emitter(vec3{6})));
    set_bright_texel(scene, 3, 4, 0.7f);
    for (vec3& texel : scene.environment->radiance) texel += vec3{0.1f};
    World const world = world_of(scene);
    WorldView const v = view(world);
    ASSERT_EQ(v.emitters.size(), 2u);
    vec3 const point{0.2f, 0.1f, -0.3f};
    Pcg32 rng(3003, 0);
    int lamp = 0, sky = 0, at_border = 0;
    for (int i = 0; i < 20000; ++i) {
        double const u_select = rng.uniform_double();
        LightSample const s = sample_light(v, choose_light(v, u_select), point, rng.uniform2());
        if (!(s.pdf > 0)) continue;
        ASSERT_FALSE(s.delta);
        ASSERT_NEAR(glm::length(s.direction), 1, 1e-5);
        if (s.distance == kInf) {
            ++sky;
            // Rounding may carry a direction over the border of its texel.
            if (std::abs(environment_direction_pdf(v, s.direction) / s.pdf - 1) > 1e-3f) ++at_border;
            vec3 const radiance = environment_radiance(v, s.direction);
            ASSERT_NEAR(radiance.x, s.radiance.x, 1e-3);
            continue;
        }
        ++lamp;
        vec3 const on = point + s.distance * s.direction;
        std::uint32_t const triangle = dark + (on.z + 0.5f > on.x + 0.5f ? 1 : 0); // diagonal of the square
        uvec3 const t = v.triangles[triangle];
        vec3 const normal =
            glm::normalize(glm::cross(v.positions[t.y] - v.positions[t.x], v.positions[t.z] - v.positions[t.x]));
        float const cosine = std::abs(glm::dot(normal, s.direction));
        ASSERT_NEAR(emitter_direction_pdf(v, triangle, s.distance, cosine) / s.pdf, 1, 1e-4);
        ASSERT_EQ(s.radiance, vec3{6});
    }
    EXPECT_GT(lamp, 1000);
    EXPECT_GT(sky, 1000);
    EXPECT_LE(at_border, sky / 1000);
    EXPECT_EQ(emitter_direction_pdf(v, 0, 1, 1), 0) << "a dark triangle";
}

TEST(LightSampling, EnvironmentSamplesFollowTheirDensity)
{
    struct Case {
        std::uint32_t x, y;
        float background, rotation;
    };
    std::vector<Case> const cases{{3, 4, 0.1f, 0}, {3, 4, 0.1f, 0.7f}, {0, 0, 0.01f, -2}, {15, 7, 0.3f, 10}};
    double const level = sidak_level(0.01, cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        Scene scene = dark_room();
        set_bright_texel(scene, cases[i].x, cases[i].y, cases[i].rotation);
        for (vec3& texel : scene.environment->radiance) texel += vec3{cases[i].background};
        World const world = world_of(scene);
        WorldView const v = view(world);
        ASSERT_EQ(world.environment_pdf, 1);
        SphereBins bins;
        bins.frame = Frame::about({0, 1, 0}); // the density is infinite at the poles of the map
        Pcg32 rng(3004, i);
        auto const draw = [&]() -> std::optional<vec3> {
            double const u_select = rng.uniform_double();
            LightSample const s = sample_light(v, choose_light(v, u_select), vec3{0}, rng.uniform2());
            return s.pdf > 0 ? std::optional(s.direction) : std::nullopt;
        };
        auto const density = [&](vec3 d) { return double(environment_direction_pdf(v, d)); };
        SphereChi2 const result = test_sampler(bins, draw, density, 200000);
        EXPECT_GT(result.p, level) << "case " << i << ": integral " << result.integral;
        EXPECT_NEAR(result.integral, 1, 1e-3) << "case " << i;
        EXPECT_LE(result.rejected, 1e-4) << "case " << i;
    }
}

/// Black light is not sampled; of what shines, everything is.
TEST(LightSampling, OnlyWhatShinesIsChosen)
{
    Scene scene = dark_room();
    add_light(scene, punctual(LightType::point, {0, 1, 0}, {0, -1, 0}, 0));
    add_light(scene, punctual(LightType::point, {1, 1, 0}, {0, -1, 0}, 1));
    add_light(scene, punctual(LightType::directional, {0, 0, 0}, {0, -1, 0}, 0));
    World const world = world_of(scene);
    WorldView const v = view(world);
    Pcg32 rng(3005, 0);
    for (int i = 0; i < 1000; ++i) {
        double const u_select = rng.uniform_double();
        LightSample const s = sample_light(v, choose_light(v, u_select), vec3{0}, rng.uniform2());
        ASSERT_GT(s.radiance.x, 0);
        ASSERT_EQ(s.pdf, 1);
    }
    EXPECT_EQ(sample_light(view(world_of(dark_room())), choose_light(view(world_of(dark_room())), 0.5), vec3{0},
                           vec2{0.5f})
                  .pdf,
              0)
        << "no light at all";
}

TEST(LightSampling, TinyAndFarTrianglesGiveFiniteNumbers)
{
    for (float const size : {1e-3f, 1e-10f, 1e-18f, 1e-22f, 1e15f}) {
        Scene scene;
        add_quad(scene, {0, 0, 0}, {0, 0, size}, {size, 0, 0}, add_material(scene, emitter(vec3{1}, true)));
        World const world = world_of(scene);
        WorldView const v = view(world);
        Pcg32 rng(3006, 0);
        for (float const distance : {0.0f, size, 1.0f, 1e6f})
            for (int i = 0; i < 100; ++i) {
                double const u_select = rng.uniform_double();
                LightSample const s = sample_light(v, choose_light(v, u_select), {0, distance, 0}, rng.uniform2());
                ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0 && all_finite(s.radiance))
                    << size << " " << distance;
                ASSERT_TRUE(std::isfinite(s.radiance.x / s.pdf) || s.pdf == 0) << size << " " << distance;
                for (std::uint32_t t = 0; t < v.triangles.size(); ++t) {
                    float const density = emitter_direction_pdf(v, t, distance, 0.5f);
                    ASSERT_TRUE(density >= 0) << density << ": " << size << " " << distance;
                }
            }
    }
}

} // namespace
} // namespace gi::test
