#include "ar/light/lat_long.h"

#include "gi/core/error.h"
#include "gi/core/rotation.h"
#include "tests/ar_light/environments.h"

#include <gtest/gtest.h>
#include <numbers>

namespace ar::test {
namespace {

TEST(LatLong, DirectionsComeBack)
{
    for (int j = 0; j < 32; ++j)
        for (int i = 0; i < 64; ++i) {
            glm::dvec3 const d = texel_direction({64, 32}, i, j);
            EXPECT_NEAR(glm::length(d), 1, 1e-14);
            glm::dvec2 const uv = uv_of(d);
            EXPECT_NEAR(uv.x * 64, i + 0.5, 1e-9);
            EXPECT_NEAR(uv.y * 32, j + 0.5, 1e-9);
        }
    EXPECT_NEAR(glm::length(direction_of_uv({0.5, 0.5}) - glm::dvec3(0, 0, -1)), 0, 1e-12);
    EXPECT_NEAR(glm::length(direction_of_uv({0.75, 0.5}) - glm::dvec3(1, 0, 0)), 0, 1e-12);
}

TEST(LatLong, SolidAnglesSumToASphere)
{
    double sum = 0;
    for (int j = 0; j < 17; ++j) sum += 34 * texel_sr({34, 17}, j);
    EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
    cv::Mat const white(16, 32, CV_32FC3, cv::Scalar(1, 2, 3));
    EXPECT_NEAR(integral(white)[2], 12 * std::numbers::pi, 1e-6);
}

TEST(LatLong, TurningKeepsTheLightAndTheDirections)
{
    cv::Mat const map = drawn({256, 128}, kRoom);
    glm::dquat const turn = gi::exp_rotation({0.3, 1.1, -0.4});
    cv::Mat const turned = resampled(map, {256, 128}, turn);
    cv::Vec3d const a = integral(map), b = integral(turned);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(b[c] / a[c], 1, 0.005);
    glm::dvec3 const d = glm::normalize(glm::dvec3(0.2, 0.1, -0.9));
    EXPECT_NEAR(sample(turned, turn * d)[1], sample(map, d)[1], 0.02);
    cv::Vec3d const small = integral(resampled(map, {32, 16}));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(small[c] / a[c], 1, 0.005);
}

TEST(LatLong, HolesAreFilledSmoothlyAndCounted)
{
    // Red and blue are constant: that solves Laplace's equation. Green is not harmonic on the sphere, but nearly.
    PartialMap map{drawn({128, 64}, [](glm::dvec3 d) { return cv::Vec3d(2, 1 + 0.5 * d.x, 1); }),
                   cv::Mat::ones(64, 128, CV_32FC1)};
    cv::Mat const whole = map.radiance.clone();
    int holes = 0;
    for (int j = 0; j < 64; ++j)
        for (int i = 0; i < 128; ++i)
            if (glm::dot(texel_direction({128, 64}, i, j), glm::normalize(glm::dvec3(0.3, 1, 0.2))) > 0.9) {
                map.weight.at<float>(j, i) = 0;
                map.radiance.at<cv::Vec3f>(j, i) = cv::Vec3f(0, 0, 0);
                ++holes;
            }
    FilledMap const f = filled(map);
    EXPECT_EQ(f.filled_texels, holes);
    EXPECT_NEAR(f.filled_share, 0.05, 0.003);
    cv::Mat miss;
    cv::absdiff(f.radiance, whole, miss);
    double most = 0;
    cv::minMaxLoc(miss.reshape(1), nullptr, &most);
    EXPECT_LT(most, 0.05);
    cv::Vec3f const middle = sample(f.radiance, glm::normalize(glm::dvec3(0.3, 1, 0.2)));
    EXPECT_NEAR(middle[0], 2, 1e-4);
    EXPECT_NEAR(middle[2], 1, 1e-4);
    map.weight.setTo(0);
    EXPECT_THROW(filled(map), gi::InputError);
    EXPECT_THROW(filled({}), gi::InputError);
}

TEST(LatLong, MergesByWeight)
{
    PartialMap a{cv::Mat(8, 16, CV_32FC3, cv::Scalar(1, 1, 1)), cv::Mat(8, 16, CV_32FC1, cv::Scalar(3))};
    PartialMap b{cv::Mat(8, 16, CV_32FC3, cv::Scalar(5, 5, 5)), cv::Mat(8, 16, CV_32FC1, cv::Scalar(1))};
    a.weight.row(0) = 0;
    a.weight.row(7) = 0;
    b.weight.row(7) = 0;
    PartialMap const m = merged(std::vector{a, b});
    EXPECT_EQ(m.radiance.at<cv::Vec3f>(0, 3)[0], 5);
    EXPECT_EQ(m.radiance.at<cv::Vec3f>(4, 3)[0], 2);
    EXPECT_EQ(m.weight.at<float>(7, 3), 0);
    EXPECT_NEAR(covered_share(m), 1 - (1 - std::cos(std::numbers::pi / 8)) / 2, 1e-6);
}

TEST(LatLong, OfWhatIsNoMapIsRefused)
{
    cv::Mat const good(8, 16, CV_32FC3, cv::Scalar(1, 1, 1));
    EXPECT_NO_THROW(check_map(good, "map"));
    EXPECT_THROW(check_map({}, "map"), gi::InputError);
    EXPECT_THROW(check_map(cv::Mat(8, 15, CV_32FC3, cv::Scalar(1, 1, 1)), "map"), gi::InputError);
    EXPECT_THROW(check_map(cv::Mat(8, 16, CV_8UC3, cv::Scalar(1, 1, 1)), "map"), gi::InputError);
    for (float const bad : {-1e-3f, std::nanf(""), HUGE_VALF}) {
        cv::Mat m = good.clone();
        m.at<cv::Vec3f>(3, 4)[1] = bad;
        EXPECT_THROW(check_map(m, "map"), gi::InputError);
    }
}

} // namespace
} // namespace ar::test
