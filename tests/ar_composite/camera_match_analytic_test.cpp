// What virtual pixels share with the camera: spread of edges, motion, noise; measured as a camera's is.

#include "ar/composite/blur.h"
#include "ar/composite/composite.h"
#include "ar/composite/edge_spread.h"
#include "gi/core/error.h"
#include "tests/ar_composite/test_pictures.h"

#include <cmath>
#include <gtest/gtest.h>
#include <iostream>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

double normal_integral(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

struct Square {
    glm::dvec2 centre{60.3, 58.8};
    double half = 30, angle = 0.2;
    glm::dvec2 corner(int i) const
    {
        double const a = angle + std::numbers::pi / 4 + i * std::numbers::pi / 2;
        return centre + half * std::numbers::sqrt2 * glm::dvec2(std::cos(a), std::sin(a));
    }
    std::vector<EdgeSegment> edges() const
    {
        std::vector<EdgeSegment> all;
        for (int i = 0; i < 4; ++i) all.push_back({corner(i), corner((i + 1) % 4)});
        return all;
    }
    /// The share of it at a place, spread by a Gaussian.
    double share(glm::dvec2 p, double sigma) const
    {
        glm::dvec2 const u(std::cos(angle), std::sin(angle)), v(-u.y, u.x), q = p - centre;
        auto const inside = [&](double d) {
            return normal_integral((d + half) / sigma) - normal_integral((d - half) / sigma);
        };
        return inside(glm::dot(q, u)) * inside(glm::dot(q, v));
    }
};

/// A dark marker on paper.
cv::Mat marker(Square const& square, double sigma, double noise = 0)
{
    cv::Mat light(120, 120, CV_32FC1);
    cv::RNG random{4};
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 120; ++x)
            light.at<float>(y, x) = float(0.8 - 0.75 * square.share({x, y}, sigma) + random.gaussian(noise));
    return light;
}

TEST(EdgeSpread, IsFoundFromMarkers)
{
    double worst = 0, worst_noisy = 0;
    for (double const angle : {0.0, 0.1, 0.2, 0.6})
        for (double const sigma : {0.4, 0.7, 1.0, 1.5, 2.2}) {
            Square square;
            square.angle = angle;
            std::vector<EdgeSegment> edges = square.edges();
            for (EdgeSegment& e : edges) { // detectors are a little off
                e.from += glm::dvec2(0.3, -0.2);
                e.to += glm::dvec2(-0.1, 0.4);
            }
            auto const clean = estimate_sharpness(marker(square, sigma), edges);
            auto const noisy = estimate_sharpness(marker(square, sigma, 0.02), edges);
            ASSERT_TRUE(clean && noisy);
            EXPECT_EQ(clean->edges, 4);
            worst = std::max(worst, std::abs(clean->sigma_px / sigma - 1));
            worst_noisy = std::max(worst_noisy, std::abs(noisy->sigma_px / sigma - 1));
        }
    std::cout << "sigma of edges, 0.4 to 2.2 px: off by at most " << 100 * worst << " %, with noise of 2.7 % "
              << 100 * worst_noisy << " %\n";
    EXPECT_LT(worst, 0.02);
    EXPECT_LT(worst_noisy, 0.06);
}

TEST(EdgeSpread, RefusesWhatIsNoEdge)
{
    cv::Mat const flat(120, 120, CV_32FC1, cv::Scalar(0.5));
    Square const square;
    EXPECT_FALSE(estimate_sharpness(flat, square.edges()));
    cv::Mat texture(120, 120, CV_32FC1);
    cv::randu(texture, 0, 1);
    EXPECT_FALSE(estimate_sharpness(texture, square.edges()));
    EXPECT_FALSE(fit_edge(marker(square, 1), {{5, 5}, {8, 5}})) << "too short";
    EXPECT_FALSE(fit_edge(marker(square, 1), {{-900, -500}, {-800, -500}}));
    EXPECT_THROW(fit_edge(cv::Mat(9, 9, CV_8UC1), {{1, 1}, {8, 8}}), gi::InputError);
}

/// A virtual marker, drawn as a renderer does: the mean over each pixel. The place behind is 0.8 everywhere.
RenderedPair virtual_marker(Square const& square)
{
    RenderedPair pair{cv::Mat(120, 120, CV_32FC3), cv::Mat(120, 120, CV_32FC3, cv::Scalar::all(0.8)),
                      cv::Mat(120, 120, CV_32FC1)};
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 120; ++x) {
            int inside = 0;
            for (int j = 0; j < 16; ++j)
                for (int i = 0; i < 16; ++i)
                    inside += square.share({x + (i - 7.5) / 16, y + (j - 7.5) / 16}, 1e-6) > 0.5;
            float const a = float(inside) / 256;
            pair.coverage.at<float>(y, x) = a;
            pair.with.at<cv::Vec3f>(y, x) = cv::Vec3f::all(a * 0.05f + (1 - a) * 0.8f);
        }
    return pair;
}

cv::Mat light_of(RenderedPair const& pair)
{
    // As composed with a camera that sees 0.8.
    cv::Mat light(pair.with.size(), CV_32FC1);
    light.forEach<float>([&](float& v, int const* at) {
        float const a = pair.coverage.at<float>(at[0], at[1]);
        v = pair.with.at<cv::Vec3f>(at[0], at[1])[1] +
            (1 - a) * (0.8f - pair.without.at<cv::Vec3f>(at[0], at[1])[1]);
    });
    return light;
}

TEST(Defocus, MakesVirtualMarkersAsSharpAsRealOnes)
{
    Square const square;
    RenderedPair const sharp = virtual_marker(square);
    for (double const camera_px : {0.6, 0.9, 1.4, 2.0}) {
        RenderedPair const blurred = defocused(sharp, missing_blur_px(camera_px));
        auto const found = estimate_sharpness(light_of(blurred), square.edges());
        ASSERT_TRUE(found);
        std::cout << "wanted " << camera_px << " px, measured " << found->sigma_px << " px\n";
        EXPECT_NEAR(found->sigma_px, camera_px, 0.05) << "a square pixel and a narrow blur make no Gaussian";
        EXPECT_LT(cv::norm(light_of(blurred), marker(square, camera_px), cv::NORM_INF), 0.05);
    }
    EXPECT_EQ(defocused(sharp, 0).with.data, sharp.with.data);
    EXPECT_EQ(missing_blur_px(0.2), 0);
    EXPECT_THROW(defocused(sharp, -1), gi::InputError);
}

TEST(Defocus, KeepsNothingNothing)
{
    cv::Mat const camera = camera_frame({50, 40});
    RenderedPair pair = unchanged_pair({50, 40});
    pair.with.at<cv::Vec3f>(20, 10) *= 3;
    cv::Mat out;
    for (RenderedPair const& blurred :
         {defocused(pair, 1.0), motion_blurred(pair, cv::Mat(40, 50, CV_32FC2, cv::Scalar(4, 2)))}) {
        Compositor{srgb_photometry()}(camera, blurred, {}, out);
        EXPECT_TRUE(equal(out.colRange(15, 50), camera.colRange(15, 50)));
        EXPECT_FALSE(equal(out, camera));
    }
}

TEST(MotionBlur, IsTheMeanAlongThePath)
{
    // A vertical border that moves 8 pixels across: a ramp of 8 pixels.
    RenderedPair pair{cv::Mat(20, 60, CV_32FC3, cv::Scalar::all(0.5)),
                      cv::Mat(20, 60, CV_32FC3, cv::Scalar::all(0.5)), cv::Mat::zeros(20, 60, CV_32FC1)};
    pair.with.colRange(0, 30) = cv::Scalar::all(0.1);
    pair.coverage.colRange(0, 30) = 1;
    cv::Mat velocity(20, 60, CV_32FC2, cv::Scalar(0, 0));
    velocity.colRange(0, 30) = cv::Scalar(8, 0); // the place behind stands still
    RenderedPair const blurred = motion_blurred(pair, velocity);
    double worst = 0;
    for (int x = 0; x < 60; ++x) {
        double const wanted = std::clamp((29.5 + 4 - x) / 8, 0.0, 1.0);
        worst = std::max(worst, std::abs(blurred.coverage.at<float>(10, x) - wanted));
        EXPECT_NEAR(blurred.with.at<cv::Vec3f>(10, x)[0], 0.1 * wanted + 0.5 * (1 - wanted), 0.03);
    }
    std::cout << "ramp of a moving border: off by at most " << worst << "\n";
    EXPECT_LT(worst, 0.07);
    EXPECT_EQ(motion_blurred(pair, cv::Mat(20, 60, CV_32FC2, cv::Scalar(0, 0))).with.data, pair.with.data);
    EXPECT_THROW(motion_blurred(pair, cv::Mat()), gi::InputError);
}

TEST(ImageVelocity, IsThatOfStandingThings)
{
    CameraModel const camera{LensModel::pinhole, {80, 60}, 70, 70, 39.5, 29.5, {}};
    cv::Mat depth(60, 80, CV_32FC1, cv::Scalar(2));
    depth.colRange(0, 10) = 0;
    gi::RigidPose before, after;
    after.position.x = 0.1; // to the right: things move to the left by 70 * 0.1 / 2
    cv::Mat const v = image_velocity(camera, depth, before, after);
    EXPECT_NEAR(v.at<cv::Vec2f>(30, 40)[0], -3.5, 1e-4);
    EXPECT_NEAR(v.at<cv::Vec2f>(30, 40)[1], 0, 1e-4);
    EXPECT_EQ(v.at<cv::Vec2f>(30, 5), cv::Vec2f(0, 0)) << "far away";
}

TEST(Noise, HasTheVarianceOfTheSensor)
{
    // An object of 0.3 over a noisy frame of 0.5: fully, by half, and a shadow:
    // variances as the camera's would be.
    cv::Size const size(256, 256);
    Photometry p = srgb_photometry();
    for (auto& channel : p.unit_of_byte)
        for (std::size_t b = 0; b < 256; ++b) channel[b] = float(b) / 255; // linear: bytes round alike everywhere
    CompositeSettings settings;
    settings.noise.constant = {2e-4f, 2e-4f, 2e-4f};
    settings.noise.per_unit = {2e-3f, 2e-3f, 2e-3f};
    cv::Mat camera(size, CV_32FC3);
    cv::RNG random{8};
    random.fill(camera, cv::RNG::NORMAL, 0.5, std::sqrt(2e-4 + 2e-3 * 0.5));
    cv::Mat const bytes = bytes_of(camera, p);
    double const rounding = 1 / (12.0 * 255 * 255);
    auto const check_variance = [&](double a, double object, double place_change, double wanted_mean,
                                    double tolerance) {
        RenderedPair const pair{
            cv::Mat(size, CV_32FC3, cv::Scalar::all(a * object + (1 - a) * (0.4 + place_change))),
            cv::Mat(size, CV_32FC3, cv::Scalar::all(0.4)), cv::Mat(size, CV_32FC1, cv::Scalar(a))};
        cv::Mat out;
        Compositor(p, settings)(bytes, pair, {}, out, 5);
        cv::Scalar mean, deviation;
        cv::meanStdDev(radiance_of(out, p), mean, deviation);
        double const wanted = 2e-4 + 2e-3 * wanted_mean;
        std::cout << "coverage " << a << ", change " << place_change << ": mean " << mean[1] << ", variance "
                  << deviation[1] * deviation[1] - rounding << " (sensor: " << wanted << ")\n";
        EXPECT_NEAR(mean[1], wanted_mean, 2e-3);
        EXPECT_NEAR(deviation[1] * deviation[1] - rounding, wanted, tolerance * wanted);
    };
    check_variance(1, 0.3, 0, 0.3, 0.03);
    check_variance(0.5, 0.3, 0, 0.4, 0.05);
    check_variance(0, 0, 0.2, 0.7, 0.05);
    check_variance(0, 0, -0.2, 0.3,
                   0.6); // darker: the camera's noise is more than wanted, and cannot be taken away
}

TEST(Noise, HasItsGrainAndRepeats)
{
    SensorNoise noise;
    noise.constant = {1, 1, 1};
    noise.grain_sigma_px = 0.8f;
    NoiseField const field(noise), again(noise);
    EXPECT_TRUE(equal(field.tile(), again.tile()));
    EXPECT_EQ(field.offset(3), again.offset(3));
    EXPECT_NE(field.offset(3), field.offset(4));
    noise.seed = 2;
    EXPECT_FALSE(equal(field.tile(), NoiseField(noise).tile()));
    // Neighbours at the distance 1 of noise spread by sigma correlate by exp(-1 / (4 sigma^2)).
    double sum = 0;
    int const n = NoiseField::kSize;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            sum += field.tile().at<cv::Vec3f>(y, x)[0] * field.tile().at<cv::Vec3f>(y, (x + 1) % n)[0];
    EXPECT_NEAR(sum / (n * n), std::exp(-1 / (4 * 0.64)), 0.02);
    // The same frame number gives the same bytes.
    cv::Mat const camera = camera_frame({40, 30});
    RenderedPair pair = unchanged_pair({40, 30});
    pair.coverage = cv::Scalar(1);
    CompositeSettings settings;
    settings.noise.constant = {1e-2f, 1e-2f, 1e-2f};
    Compositor composite(srgb_photometry(), settings);
    cv::Mat a, b, c;
    composite(camera, pair, {}, a, 7);
    composite(camera, pair, {}, b, 7);
    composite(camera, pair, {}, c, 8);
    EXPECT_TRUE(equal(a, b));
    EXPECT_FALSE(equal(a, c));
}

} // namespace
} // namespace ar::test
