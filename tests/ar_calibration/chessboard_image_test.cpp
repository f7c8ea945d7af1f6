// A plain chessboard, drawn ray by ray through a known camera.

#include "ar/calibration/lens.h"
#include "tests/ar_markers/drawn_view.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

constexpr int kCornersX = 9, kCornersY = 6;
constexpr double kSquare_m = 0.03;

/// Light of 0..1: squares with one corner of four in the origin, a white margin, grey around.
float board_at(double x_m, double y_m)
{
    double const u = x_m / kSquare_m + 1, v = y_m / kSquare_m + 1;
    if (u < -0.7 || v < -0.7 || u > kCornersX + 1.7 || v > kCornersY + 1.7) return 0.3f;
    if (u < 0 || v < 0 || u > kCornersX + 1 || v > kCornersY + 1) return 0.9f;
    return (int(u) + int(v)) % 2 == 0 ? 0.04f : 0.9f;
}

constexpr int kRays = 3; ///< each way, per pixel

std::vector<glm::dvec3> rays_of(CameraModel const& camera)
{
    std::vector<glm::dvec3> rays;
    for (int y = 0; y < camera.size_px.y; ++y)
        for (int x = 0; x < camera.size_px.x; ++x)
            for (int s = 0; s < kRays * kRays; ++s)
                rays.push_back(*direction_of(
                    camera, {x - 0.5 + (s % kRays + 0.5) / kRays, y - 0.5 + (s / kRays + 0.5) / kRays}));
    return rays;
}

cv::Mat picture(glm::ivec2 size_px, std::vector<glm::dvec3> const& rays, gi::RigidPose const& board_from_camera,
                std::uint64_t seed)
{
    cv::Mat light(size_px.y, size_px.x, CV_32FC1);
    auto ray = rays.begin();
    for (int y = 0; y < light.rows; ++y)
        for (int x = 0; x < light.cols; ++x) {
            float sum = 0;
            for (int s = 0; s < kRays * kRays; ++s, ++ray) {
                glm::dvec3 const d = board_from_camera.rotation * *ray;
                glm::dvec3 const at = board_from_camera.position - board_from_camera.position.z / d.z * d;
                sum += d.z < 0 ? board_at(at.x, at.y) : 0.3f;
            }
            light.at<float>(y, x) = sum / (kRays * kRays);
        }
    cv::GaussianBlur(light, light, {}, 0.5);
    cv::Mat bytes, noise(light.size(), CV_32FC1);
    cv::RNG rng(seed + 1);
    rng.fill(noise, cv::RNG::NORMAL, 0, 1.5);
    cv::pow(light, 1 / 2.2, light);
    cv::Mat(255 * light + noise).convertTo(bytes, CV_8U);
    return bytes;
}

TEST(Chessboard, IsFoundAndCalibratesADrawnLens)
{
    CameraModel const truth{LensModel::radial_tangential,        {640, 480}, 525, 528, 318.5, 243.25,
                            {-0.28, 0.09, 0.001, -0.0007, -0.01}};
    std::vector<glm::dvec3> const rays = rays_of(truth);
    std::vector<BoardView> views;
    double sum = 0;
    int points = 0;
    cv::RNG rng(5);
    for (int i = 0; i < 14; ++i) {
        glm::dvec3 const middle(0.12, 0.075, 0);
        double const a = rng.uniform(-0.6, 0.6), b = rng.uniform(-0.6, 0.6);
        gi::RigidPose const pose = looking(
            middle + rng.uniform(0.42, 0.6) * glm::normalize(glm::dvec3(std::sin(a), std::sin(b), std::cos(a))),
            middle + glm::dvec3(rng.uniform(-0.05, 0.05), rng.uniform(-0.04, 0.04), 0));
        auto const view = find_chessboard(picture(truth.size_px, rays, pose, std::uint64_t(i)), kCornersX,
                                          kCornersY, kSquare_m, fmt::format("view {}", i));
        if (!view) continue;
        ASSERT_EQ(view->pixels.size(), std::size_t(kCornersX * kCornersY));
        // Counted from either end: a board that is turned about looks the same but for its colours.
        double straight = 0, turned = 0;
        for (std::size_t k = 0; k < view->pixels.size(); ++k) {
            auto const at = [&](std::size_t n) { return *project(truth, inverse(pose) * view->board_m[n]); };
            straight += glm::dot(view->pixels[k] - at(k), view->pixels[k] - at(k));
            glm::dvec2 const d = view->pixels[k] - at(view->pixels.size() - 1 - k);
            turned += glm::dot(d, d);
        }
        sum += std::min(straight, turned);
        points += int(view->pixels.size());
        views.push_back(*view);
    }
    LensCalibration const c = calibrate_lens(views, truth.size_px, truth.lens);
    auto const is = parameters_of(c.camera), was = parameters_of(truth);
    fmt::print("{} of 14 views; corners {:.3f} px rms off; reprojection {:.3f} px; fx {:+.3f} %, fy {:+.3f} %\n",
               views.size(), std::sqrt(sum / points), c.rms_px, 100 * (is[0] / was[0] - 1),
               100 * (is[1] / was[1] - 1));
    EXPECT_GE(views.size(), 12u);
    EXPECT_LT(std::sqrt(sum / points), 0.15);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(std::abs(is[i] / was[i] - 1), 0.004) << c.parameters[i];
}

TEST(Chessboard, IsNotFoundWhereThereIsNone)
{
    cv::Mat const plain(480, 640, CV_8UC1, cv::Scalar(120));
    EXPECT_FALSE(find_chessboard(plain, kCornersX, kCornersY, kSquare_m, "plain"));
    cv::Mat noise(480, 640, CV_8UC1);
    cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 255);
    EXPECT_FALSE(find_chessboard(noise, kCornersX, kCornersY, kSquare_m, "noise"));
}

} // namespace
} // namespace ar::test
