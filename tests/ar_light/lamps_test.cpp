#include "ar/light/lamps.h"

#include "tests/ar_light/environments.h"
#include "tests/ar_light/irradiance_maps.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numbers>

namespace ar::test {
namespace {

std::vector<Disc> const kDiscs{{{0.3, 0.9, 0.2}, 0.08, 60},
                               {{0.01, 0.3, 1}, 0.06, 60},   // on the seam
                               {{0.02, 1, -0.01}, 0.05, 50}, // at the pole
                               {{-1, -0.2, -0.4}, 0.02, 300}};

double angle_deg(glm::dvec3 a, glm::dvec3 b)
{
    return glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

TEST(Lamps, AreFoundWhereTheyAreAndKeepTheLight)
{
    cv::Mat const map = drawn({512, 256}, with_discs(kRoom, kDiscs));
    SplitMap const s = split_lamps(map);
    ASSERT_EQ(s.lamps.size(), kDiscs.size());
    for (Disc const& d : kDiscs) {
        Lamp const& l = *std::min_element(s.lamps.begin(), s.lamps.end(), [&](Lamp const& a, Lamp const& b) {
            return angle_deg(a.direction, d.direction) < angle_deg(b.direction, d.direction);
        });
        double const light = 2 * std::numbers::pi * (1 - std::cos(d.half_angle_rad)) * d.radiance;
        EXPECT_LT(angle_deg(l.direction, d.direction), 0.1);
        EXPECT_NEAR(l.irradiance[1], light, 0.04 * light);
        EXPECT_GT(l.half_angle_rad, 0.95 * d.half_angle_rad); // its rim counts, too
        EXPECT_LT(l.half_angle_rad, d.half_angle_rad + 0.03);
    }
    cv::Vec3d sum = integral(s.rest);
    for (Lamp const& l : s.lamps) sum += l.irradiance;
    cv::Vec3d const whole = integral(map), drawn_again = integral(with_lamps(s.rest, s.lamps));
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sum[c] / whole[c], 1, 1e-4);
        EXPECT_NEAR(drawn_again[c] / whole[c], 1, 1e-4);
    }
    double const error =
        relative_error2(irradiance_map(with_lamps(s.rest, s.lamps), {32, 16}), irradiance_map(map, {32, 16}));
    fmt::print("lamps drawn as discs: relMSE of irradiance {:.1e}, lamps hold {:.0f} % of the light\n", error,
               100 * s.lamp_share);
    EXPECT_LT(error, 1e-4);
    double brightest = 0;
    cv::minMaxLoc(s.rest.reshape(1), nullptr, &brightest);
    EXPECT_LT(brightest, 10);
}

TEST(Lamps, OfEvenSkiesAreNone)
{
    cv::Mat const map = drawn({128, 64}, kRoom);
    SplitMap const s = split_lamps(map);
    EXPECT_TRUE(s.lamps.empty());
    EXPECT_EQ(cv::norm(s.rest, map, cv::NORM_INF), 0);
    EXPECT_TRUE(split_lamps(cv::Mat::zeros(8, 16, CV_32FC3)).lamps.empty());
}

TEST(Lamps, ThatAreLeftInTheMapAreCounted)
{
    cv::Mat const map = drawn({512, 256}, with_discs(kRoom, kDiscs));
    LampSettings two;
    two.most = 2;
    EXPECT_EQ(split_lamps(map, two).lamps.size(), 2u);
    EXPECT_EQ(split_lamps(map, two).too_many, 2);
    LampSettings strong;
    strong.least_share = 0.05;
    EXPECT_GT(split_lamps(map, strong).too_faint, 0);
    LampSettings small;
    small.largest_sr = 1e-3;
    EXPECT_GT(split_lamps(map, small).too_large, 0);
}

TEST(Lamps, OfOneTexelKeepItsLight)
{
    cv::Mat map(16, 32, CV_32FC3, cv::Scalar(0.1, 0.1, 0.1));
    map.at<cv::Vec3f>(4, 31) = {500, 400, 300};
    SplitMap const s = split_lamps(map);
    ASSERT_EQ(s.lamps.size(), 1u);
    EXPECT_LT(angle_deg(s.lamps[0].direction, texel_direction({32, 16}, 31, 4)), 0.5);
    cv::Vec3d const sum = integral(s.rest) + s.lamps[0].irradiance;
    EXPECT_NEAR(sum[2] / integral(map)[2], 1, 1e-6);
}

} // namespace
} // namespace ar::test
