#include "ar/light/lat_long.h"
#include "tests/ar_light/environments.h"
#include "tests/ar_light/irradiance_maps.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numbers>

namespace ar::test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Irradiance, OfAWhiteSphereIsPi)
{
    cv::Mat const white(64, 128, CV_32FC3, cv::Scalar(1, 2, 0));
    for (auto const by : {IrradianceBy::harmonics, IrradianceBy::exact_sum}) {
        cv::Mat const e = irradiance_map(white, {8, 4}, by);
        for (auto const& v : cv::Mat_<cv::Vec3f>(e)) {
            EXPECT_NEAR(v[0], kPi, 2e-3);
            EXPECT_NEAR(v[1], 2 * kPi, 4e-3);
            EXPECT_EQ(v[2], 0);
        }
    }
}

TEST(Irradiance, OfALampIsItsLightByTheCosine)
{
    glm::dvec3 const lamp = glm::normalize(glm::dvec3(0.5, 0.7, -0.3));
    double const half = 0.06;
    cv::Mat const map =
        drawn({512, 256}, with_discs([](glm::dvec3) { return cv::Vec3d(0, 0, 0); }, {{lamp, half, 50}}));
    double const whole = 50 * kPi * std::sin(half) * std::sin(half); // of a disc, seen straight on
    for (glm::dvec3 const n : {lamp, glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0)})
        EXPECT_NEAR(irradiance_exact(map, n)[0], whole * std::max(0.0, glm::dot(n, lamp)), 0.01 * whole);
}

TEST(Irradiance, ByHarmonicsIsWithinWhatOrderTwoCan)
{
    cv::Mat const smooth = drawn({128, 64}, kRoom);
    double const of_room = relative_error2(irradiance_map(smooth, {32, 16}),
                                           irradiance_map(smooth, {32, 16}, IrradianceBy::exact_sum));
    cv::Mat const lit =
        drawn({256, 128}, with_discs(kRoom, {{{0.3, 0.9, 0.2}, 0.1, 40}, {{-1, 0.2, -0.4}, 0.06, 60}}));
    double const of_lamps =
        relative_error2(irradiance_map(lit, {32, 16}), irradiance_map(lit, {32, 16}, IrradianceBy::exact_sum));
    fmt::print("order 2 against exact sums, relMSE: room {:.2e}, with two lamps {:.2e}\n", of_room, of_lamps);
    EXPECT_LT(of_room, 1e-4);
    EXPECT_LT(of_lamps, 0.01);
    // What has only orders up to 2 is exact but for the texels.
    cv::Mat const poly = drawn({256, 128}, [](glm::dvec3 d) {
        return cv::Vec3d(1 + d.x, 1 + 0.5 * d.y * d.z, 2 + d.y * d.y - 0.3 * d.x * d.z);
    });
    EXPECT_LT(
        relative_error2(irradiance_map(poly, {16, 8}), irradiance_map(poly, {16, 8}, IrradianceBy::exact_sum)),
        1e-8);
}

TEST(Irradiance, ErrorsAreRelativeAndBlackIsNoError)
{
    cv::Mat const a(8, 16, CV_32FC3, cv::Scalar(1, 10, 0)), b = 1.1 * a;
    EXPECT_NEAR(relative_error2(b, a), 2.0 / 3 * 0.01 / 1.01, 1e-6);
    EXPECT_EQ(relative_error2(a, a), 0);
}

} // namespace
} // namespace ar::test
