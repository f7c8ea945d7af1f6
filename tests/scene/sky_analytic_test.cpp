// The sky of Preetham et al. against its published polynomials (numbers of another program),
// and the map against the model.

#include "gi/core/error.h"
#include "gi/scene/model/sky.h"
#include "gi/scene/shading/light_sampling.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

SkyOptions options(double turbidity, double elevation_deg, double azimuth_deg = 120)
{
    SkyOptions o;
    o.turbidity = turbidity;
    o.sun_elevation_deg = elevation_deg;
    o.sun_azimuth_deg = azimuth_deg;
    return o;
}

dvec3 direction(double elevation_deg, double azimuth_deg)
{
    double const e = glm::radians(elevation_deg), a = glm::radians(azimuth_deg);
    return {std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a)};
}

/// Integrals of the bilinear map as the renderers see it: over all directions, and times max(cos, 0).
struct Flux {
    double all = 0, horizontal = 0;
};

Flux luminous_flux(EnvironmentMap map)
{
    std::uint32_t const w = map.width, h = map.height;
    Scene scene;
    scene.environment = std::move(map);
    World const world = world_of(std::move(scene));
    WorldView const v = view(world);
    // Two Gauss points across every part's height, so that near the poles functions linear times
    // sin(theta) are integrated exactly too.
    constexpr std::uint32_t kParts = 2; // of a texel; a multiple of two: kinks lie between them
    Flux flux;
    for (std::uint32_t y = 0; y < 2 * h * kParts; ++y) {
        double const row = (y / 2 + 0.5 + (y % 2 == 0 ? -0.5 : 0.5) / std::sqrt(3.0)) / kParts;
        double const theta = row * M_PI / h;
        double const solid_angle = std::sin(theta) * M_PI / (2.0 * h * kParts) * 2 * M_PI / (w * kParts);
        double sum = 0;
        for (std::uint32_t x = 0; x < w * kParts; ++x)
            sum += double(luminance(light_detail::map_radiance(v, vec2{(float(x) + 0.5f) / kParts, float(row)})));
        flux.all += sum * solid_angle;
        flux.horizontal += sum * solid_angle * std::max(0.0, std::cos(theta));
    }
    return flux;
}

TEST(Sky, ZenithAsPublished)
{
    struct Case {
        double turbidity, elevation_deg, luminance, x, y;
    };
    for (Case const& c : {Case{2, 90, 15.500672137416844, 0.26674, 0.2772},
                          Case{3, 40, 6.525041112282447, 0.2444118911053031, 0.250520792709004},
                          Case{6, 20, 6.579691528872424, 0.2714474911592979, 0.28981314021493937},
                          Case{10, 0, 0.2642, 0.3152834415941271, 0.3441721526329402},
                          Case{2.5, 5, 2.2613318069498813, 0.270606162048025, 0.2880684181259473}}) {
        Sky const sky(options(c.turbidity, c.elevation_deg));
        EXPECT_NEAR(sky.zenith().luminance, c.luminance, 1e-9);
        EXPECT_NEAR(sky.zenith().x, c.x, 1e-9);
        EXPECT_NEAR(sky.zenith().y, c.y, 1e-9);
        LuminanceXy const seen = sky.sky({0, 1, 0}); // Perez' distribution is 1 there
        EXPECT_NEAR(seen.luminance, c.luminance, 1e-9);
        EXPECT_NEAR(seen.x, c.x, 1e-9);
        EXPECT_NEAR(seen.y, c.y, 1e-9);
        EXPECT_NEAR(double(luminance(sky.radiance({0, 1, 0}))), c.luminance, 1e-3 * c.luminance);
    }
    // Away from the zenith: 30 degrees up, 75 from the sun's azimuth.
    LuminanceXy const off = Sky(options(3, 40)).sky(direction(30, 195));
    EXPECT_NEAR(off.luminance, 8.018505121325074, 1e-9);
    EXPECT_NEAR(off.x, 0.2549699747596357, 1e-9);
    EXPECT_NEAR(off.y, 0.26548244054192294, 1e-9);
}

TEST(Sky, SymmetricAboutTheMeridianOfTheSun)
{
    for (double const turbidity : {2.0, 5.0, 10.0})
        for (double const elevation : {1.0, 30.0, 80.0}) {
            Sky const sky(options(turbidity, elevation, 77));
            for (double const up : {0.5, 10.0, 45.0, 85.0})
                for (double const away : {3.0, 60.0, 150.0}) {
                    vec3 const a = sky.radiance(direction(up, 77 + away)),
                               b = sky.radiance(direction(up, 77 - away));
                    EXPECT_LE(glm::length(a - b), 1e-5f * glm::length(a));
                }
        }
}

TEST(Sky, NeverNegativeAndFinite)
{
    for (double turbidity = 2; turbidity <= 10; turbidity += 0.5)
        for (double elevation = 0; elevation <= 90; elevation += 3) {
            SkyOptions o = options(turbidity, elevation);
            o.width = 32;
            o.height = 16;
            for (vec3 const& c : sky_map(o).radiance)
                ASSERT_TRUE(all_finite(c) && std::min({c.x, c.y, c.z}) >= 0 && max_component(c) > 0)
                    << turbidity << " " << elevation;
        }
}

TEST(Sky, TheSunIsThatOfADay)
{
    // About 133 klx outside the atmosphere; 80 to 110 reach the ground from a high
    // sun in clear air. Blue goes first.
    double const solid_angle = 2 * M_PI * (1 - std::cos(kSunRadiusRad));
    EXPECT_NEAR(solid_angle, M_PI * std::pow(0.533 / 2 * M_PI / 180, 2), 1e-9);
    auto const illuminance = [&](double turbidity, double elevation) {
        return solid_angle * double(luminance(vec3(Sky(options(turbidity, elevation)).sun_radiance())));
    };
    EXPECT_GT(illuminance(2, 90), 85);
    EXPECT_LT(illuminance(2, 90), 115);
    double last = illuminance(3, 90);
    for (double const elevation : {60.0, 30.0, 10.0, 3.0, 0.0}) {
        EXPECT_LT(illuminance(3, elevation), last);
        last = illuminance(3, elevation);
    }
    EXPECT_LT(illuminance(3, 0), 2);
    EXPECT_LT(illuminance(8, 45), illuminance(2, 45));
    dvec3 const high = Sky(options(3, 80)).sun_radiance(), low = Sky(options(3, 8)).sun_radiance();
    EXPECT_LT(low.z / low.x, 0.5 * high.z / high.x);
}

TEST(Sky, TheSunHasItsPowerAtEverySize)
{
    double const solid_angle = 2 * M_PI * (1 - std::cos(kSunRadiusRad));
    for (double const elevation : {0.5, 12.0, 40.0, 73.3, 90.0})
        for (std::uint32_t const width : {64u, 128u, 256u, 512u, 1024u, 2048u}) {
            if (width > 256 && elevation != 40) continue; // they take long
            SkyOptions o = options(3, elevation, -33);
            o.width = width;
            o.height = width / 2;
            EnvironmentMap sun = sky_map(o);
            o.sun = false;
            EnvironmentMap const without = sky_map(o);
            for (std::size_t i = 0; i < sun.radiance.size(); ++i) sun.radiance[i] -= without.radiance[i];
            double const power = solid_angle * double(luminance(vec3(Sky(o).sun_radiance())));
            Flux const flux = luminous_flux(sun);
            EXPECT_NEAR(flux.all, power, 1e-3 * power) << elevation << " " << width;
            double const cosine = std::sin(glm::radians(elevation));
            double const tolerance = elevation == 90 && width == 64 ? 4e-3 : 1e-3;
            EXPECT_NEAR(flux.horizontal, power * cosine, tolerance * power * cosine) << elevation << " " << width;
        }
}

TEST(Sky, ItsEnergyDoesNotDependOnTheSize)
{
    for (double const elevation : {3.0, 40.0, 85.0}) {
        Flux reference;
        for (std::uint32_t const width : {1024u, 512u, 128u, 64u}) {
            SkyOptions o = options(3, elevation);
            o.width = width;
            o.height = width / 2;
            Flux const flux = luminous_flux(sky_map(o));
            if (width == 1024) reference = flux;
            EXPECT_NEAR(flux.all, reference.all, 0.01 * reference.all) << elevation << " " << width;
            EXPECT_NEAR(flux.horizontal, reference.horizontal, 0.01 * reference.horizontal) << elevation;
        }
    }
}

TEST(Sky, TheSunStandsWhereItWasPut)
{
    for (double const azimuth : {0.0, 90.0, 200.0, -120.0}) {
        SkyOptions o = options(4, 25, azimuth);
        o.width = 512;
        o.height = 256;
        EnvironmentMap const map = sky_map(o);
        std::size_t brightest = 0;
        for (std::size_t i = 0; i < map.radiance.size(); ++i)
            if (luminance(map.radiance[i]) > luminance(map.radiance[brightest])) brightest = i;
        // Ask the map as the renderers do: nothing else is nearly as bright.
        Scene scene;
        scene.environment = map;
        World const world = world_of(scene);
        double const there = double(luminance(environment_radiance(view(world), vec3(direction(25, azimuth)))));
        EXPECT_GT(there, 0.2 * double(luminance(map.radiance[brightest]))) << azimuth;
        EXPECT_LT(double(luminance(environment_radiance(view(world), vec3(direction(25, azimuth + 5))))),
                  1e-3 * there);
    }
}

TEST(Sky, TheGroundReflectsWhatFallsOnIt)
{
    SkyOptions o = options(3, 40);
    o.ground_albedo = {1, 0.5f, 0};
    o.width = 512;
    o.height = 256;
    vec3 const ground = Sky(o).radiance({0, -1, 0});
    double const illuminance = luminous_flux(sky_map(o)).horizontal;
    o.ground_albedo = vec3{1};
    double const white = double(luminance(Sky(o).radiance({0.6, -0.8, 0})));
    EXPECT_NEAR(white * M_PI, illuminance, 0.02 * illuminance); // half a row of ground lies above the horizon
    EXPECT_EQ(ground.z, 0);
    EXPECT_NEAR(ground.x, Sky(o).radiance({0, -1, 0}).x, 1e-4 * ground.x);
}

TEST(Sky, WhatIsNoSkyIsRefused)
{
    for (double const turbidity : {1.9, 10.1, -1.0, double(NAN)})
        EXPECT_THROW(Sky(options(turbidity, 30)), InputError);
    for (double const elevation : {-0.1, 90.1, double(NAN)}) EXPECT_THROW(Sky(options(3, elevation)), InputError);
    EXPECT_THROW(Sky(options(3, 30, 361)), InputError);
    SkyOptions bright = options(3, 30), small = bright;
    bright.ground_albedo.y = 1.5f;
    EXPECT_THROW(Sky{bright}, InputError);
    small.width = 4;
    EXPECT_THROW(sky_map(small), InputError);
}

} // namespace
} // namespace gi::test
