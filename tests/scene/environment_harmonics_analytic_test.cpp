// Environment maps in spherical harmonics: known functions, irradiance in closed form and against integration.

#include "gi/scene/load/load.h"
#include "gi/scene/shading/environment_harmonics.h"
#include "gi/scene/shading/light_sampling.h"
#include "tests/support/data.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// A map whose texels have the values of a function in their middles.
EnvironmentMap map_of(std::uint32_t width, std::uint32_t height, std::function<dvec3(dvec3)> const& radiance)
{
    EnvironmentMap map;
    map.width = width;
    map.height = height;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            double const theta = (y + 0.5) * kPiD / height, phi = ((x + 0.5) / width - 0.5) * 2 * kPiD;
            map.radiance.push_back(vec3(
                radiance({std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)})));
        }
    return map;
}

/// Spread evenly over the sphere.
std::vector<dvec3> directions(int count)
{
    std::vector<dvec3> all;
    for (int i = 0; i < count; ++i) {
        double const y = 1 - (2 * i + 1.0) / count, phi = i * kPiD * (3 - std::sqrt(5.0)),
                     r = std::sqrt(1 - y * y);
        all.push_back({r * std::sin(phi), y, r * std::cos(phi)});
    }
    return all;
}

World lit_by(EnvironmentMap map)
{
    Scene scene;
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.5f})));
    scene.environment = std::move(map);
    return world_of(std::move(scene));
}

void expect_near(EnvironmentHarmonics const& a, EnvironmentHarmonics const& b, double tolerance)
{
    for (std::size_t i = 0; i < EnvironmentHarmonics::kMost; ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.coefficients[i][c], b.coefficients[i][c], tolerance) << i;
}

/// Ramamoorthi and Hanrahan 2001, eq. 3, whose (x, y, z) are our (z, x, y).
TEST(EnvironmentHarmonics, PolynomialsOfThePaper)
{
    for (dvec3 const d : directions(50)) {
        double const x = d.z, y = d.x, z = d.y;
        double const paper[9] = {0.282095,
                                 0.488603 * y,
                                 0.488603 * z,
                                 0.488603 * x,
                                 1.092548 * x * y,
                                 1.092548 * y * z,
                                 0.315392 * (3 * z * z - 1),
                                 1.092548 * x * z,
                                 0.546274 * (x * x - y * y)};
        auto const ours = spherical_harmonics(d);
        for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(ours[i], paper[i], 2e-6) << i;
    }
}

TEST(EnvironmentHarmonics, AConstantMapGivesPi)
{
    for (auto const& [width, height] : {std::pair{2u, 1u}, {4u, 2u}, {16u, 8u}, {7u, 5u}, {1024u, 512u}})
        for (int const degree : {0, 2, 4}) {
            EnvironmentHarmonics const h =
                project(map_of(width, height, [](dvec3) { return dvec3{1}; }), 0.3, {1, 2, 3}, degree);
            EXPECT_NEAR(h.coefficients[0].x, std::sqrt(4 * kPiD), 1e-9);
            EXPECT_NEAR(h.squared.y, 4 * 4 * kPiD, 1e-8);
            EXPECT_NEAR(h.energy_share(), 1, 1e-9);
            for (dvec3 const n : directions(40)) {
                dvec3 const e = irradiance(h, n);
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(e[c], (c + 1) * kPiD, 1e-6);
            }
        }
}

TEST(EnvironmentHarmonics, AKnownFunctionGivesItsCoefficients)
{
    // The bilinear map is a little flatter than the function: by l(l+1)/12 of a row's square, 3e-5 here.
    EnvironmentHarmonics truth;
    truth.degree = 4;
    for (std::size_t i = 0; i < EnvironmentHarmonics::kMost; ++i)
        truth.coefficients[i] = {0.1 * std::cos(2.0 * double(i)), 0.02 * double(i % 5), i == 0 ? 5.0 : -0.1};
    EnvironmentMap const map = map_of(1024, 512, [&](dvec3 d) {
        auto const y = spherical_harmonics(d);
        dvec3 sum{0};
        for (std::size_t i = 0; i < y.size(); ++i) sum += y[i] * truth.coefficients[i];
        return sum;
    });
    EnvironmentHarmonics const found = project(map, 0, dvec3{1}, 4);
    expect_near(found, truth, 3e-5);
    EXPECT_NEAR(found.energy_share(), 1, 1e-4);
    EnvironmentHarmonics const low = project(map, 0, dvec3{1}, 1);
    EXPECT_EQ(low.coefficients[3], found.coefficients[3]);
    EXPECT_EQ(low.coefficients[4], dvec3{0});
    EXPECT_LT(low.energy_share(), found.energy_share(1) + 1e-12);
    EXPECT_THROW(project(map, 0, dvec3{1}, 5), std::invalid_argument);
}

/// Of light from one direction: A_0 + 3 A_1 cos + 5 A_2 P_2(cos) + 9 A_4 P_4(cos), over 4 pi.
TEST(EnvironmentHarmonics, IrradianceOfASunIsTheTruncatedSeries)
{
    EnvironmentMap map = map_of(512, 256, [](dvec3) { return dvec3{0}; });
    std::uint32_t const x = 100, y = 60;
    map.radiance[y * 512 + x] = vec3{1000};
    double const theta = (y + 0.5) * kPiD / 256, phi = ((x + 0.5) / 512 - 0.5) * 2 * kPiD;
    dvec3 const sun{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
    for (int const degree : {2, 4}) {
        EnvironmentHarmonics const h = project(map, 0, dvec3{1}, degree);
        double const power = h.coefficients[0].x * std::sqrt(4 * kPiD);
        EXPECT_NEAR(power / (1000 * 2 * kPiD / 512 * 2 * std::sin(theta) * std::sin(kPiD / 512)), 1, 1e-4);
        for (dvec3 const n : directions(30)) {
            double const c = glm::dot(n, sun), c2 = c * c;
            double truth = 0.25 + 0.5 * c + 5.0 / 32 * (3 * c2 - 1);
            if (degree == 4) truth -= 3.0 / 256 * (35 * c2 * c2 - 30 * c2 + 3);
            EXPECT_NEAR(irradiance(h, n).x / power, truth, 3e-4);
        }
        EXPECT_LT(h.energy_share(), 0.01);
        EXPECT_GT(glm::dot(brightest_normal(h), sun), std::cos(glm::radians(1.0)));
    }
}

TEST(EnvironmentHarmonics, IntegrationAgreesWhereTheMapIsSmooth)
{
    EnvironmentMap map = map_of(256, 128, [](dvec3 d) {
        return dvec3{2 + d.x, 2 + d.y * d.z, 3 + d.x * d.z - d.z};
    });
    map.rotation_rad = 0.7f;
    map.scale = {1, 2, 3};
    World const world = lit_by(map);
    EnvironmentHarmonics const h = project(world);
    std::vector<dvec3> const normals = directions(60);
    std::vector<dvec3> const truth = integrate_irradiance(world, normals);
    for (std::size_t i = 0; i < normals.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(irradiance(h, normals[i])[c] / truth[i][c], 1, 1e-4);
    // The radiance itself as kernels look it up: frame, rotation and scale are theirs.
    for (dvec3 const d : normals) {
        auto const y = spherical_harmonics(d);
        dvec3 sum{0};
        for (std::size_t i = 0; i < y.size(); ++i) sum += y[i] * h.coefficients[i];
        vec3 const looked_up = environment_radiance(view(world), vec3(d));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], double(looked_up[c]), 3e-3);
    }
}

TEST(EnvironmentHarmonics, ATurnedMapHasTurnedCoefficients)
{
    std::uint32_t const width = 64, height = 32, columns = 11;
    EnvironmentMap const map = map_of(width, height, [](dvec3 d) {
        return dvec3{1 + std::sin(5 * d.x), std::exp(3 * d.z), d.y > 0.3 ? 4.0 : 0.1};
    });
    EnvironmentMap moved = map; // columns to the left: counter-clockwise seen from above
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            moved.radiance[y * width + x] = map.radiance[y * width + (x + columns) % width];
    double const angle = columns * 2 * kPiD / width;
    EnvironmentHarmonics const still = project(map, 0, dvec3{1}, 4), turned = rotated(still, angle);
    expect_near(turned, project(moved, 0, dvec3{1}, 4), 1e-12);
    expect_near(turned, project(map, angle, dvec3{1}, 4), 1e-12);
    for (dvec3 const n : directions(20)) {
        double const c = std::cos(angle), s = std::sin(angle);
        dvec3 const with_it{c * n.x + s * n.z, n.y, -s * n.x + c * n.z};
        EXPECT_NEAR(irradiance(turned, with_it).y, irradiance(still, n).y, 1e-10);
    }
}

TEST(EnvironmentHarmonics, WorldsWithoutEnvironmentAreDark)
{
    World const world = world_of({});
    EXPECT_EQ(irradiance(project(world), {0, 1, 0}), dvec3{0});
    EXPECT_EQ(integrate_irradiance(world, std::vector<dvec3>{{0, 1, 0}}).at(0), dvec3{0});
}

struct RealMap {
    char const* file;
    double mean[2], largest[2]; ///< limits of relative errors, degrees 2 and 4
};

class RealMaps : public testing::TestWithParam<RealMap> {};

/// The paper: 1 % on average and 9 % at most. All three maps have this error relative to the brightest surface.
/// Relative to each surface's own light, it is larger on surfaces that face away from a sun
/// (kloppenheim) or a bright sky (dresden).
TEST_P(RealMaps, IrradianceAgainstIntegration)
{
    std::string const file = std::string("envmaps/") + GetParam().file;
    LIGHTWELL_NEED_DATA(file);
    Report report;
    World const world = lit_by(load_environment(shared_data() / file, report));
    std::vector<dvec3> const normals = directions(64);
    std::vector<dvec3> const truth = integrate_irradiance(world, normals);
    for (int const degree : {2, 4}) {
        EnvironmentHarmonics const h = project(world, degree);
        double mean = 0, largest = 0, most = 0, largest_of_most = 0;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            double const exact = truth[i].x + truth[i].y + truth[i].z;
            dvec3 const e = irradiance(h, normals[i]);
            double const off = std::abs(e.x + e.y + e.z - exact);
            most = std::max(most, exact);
            largest_of_most = std::max(largest_of_most, off);
            mean += off / exact / double(normals.size());
            largest = std::max(largest, off / exact);
        }
        fmt::print(
            "{} degree {}: relative error {:.3f} % mean, {:.3f} % largest; {:.3f} % of the brightest at most; "
            "share of squared radiance {:.2f} %\n",
            GetParam().file, degree, 100 * mean, 100 * largest, 100 * largest_of_most / most,
            100 * h.energy_share());
        EXPECT_LT(mean, GetParam().mean[degree / 4]);
        EXPECT_LT(largest, GetParam().largest[degree / 4]);
        EXPECT_LT(largest_of_most, (degree == 2 ? 0.09 : 0.05) * most);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, RealMaps,
                         testing::Values(RealMap{"kloppenheim_05_1k.hdr", {0.25, 0.12}, {1.1, 0.6}},
                                         RealMap{"dresden_square_1k.hdr", {0.035, 0.009}, {0.33, 0.11}},
                                         RealMap{"autoshop_01_1k.hdr", {0.024, 0.006}, {0.12, 0.03}}),
                         [](auto const& map) {
                             std::string const name = map.param.file;
                             return name.substr(0, name.find('_'));
                         });

} // namespace
} // namespace gi::test
