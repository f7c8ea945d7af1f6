#include "ar/composite/albedo.h"

#include "ar/camera/photometry.h"
#include "gi/core/error.h"

#include <cmath>
#include <gtest/gtest.h>
#include <iostream>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

cv::Size const kSize(120, 90);
constexpr int kPatches = 6; ///< 3 x 2 tiles; patch 5 is never seen
std::vector<cv::Vec3f> const kTruth{
    {0.8f, 0.75f, 0.7f}, {0.2f, 0.25f, 0.3f}, {0.05f, 0.06f, 0.04f}, {0.6f, 0.1f, 0.1f}, {0.4f, 0.5f, 0.9f}};

int patch_at(int x, int y)
{
    int const p = x * 3 / kSize.width + 3 * (y * 2 / kSize.height);
    return p < 5 ? p : -1;
}

/// Light of a lamp that moves from frame to frame, and each patch lights the others: white_i = E_i + 0.12 sum
/// rho_j E_j, j != i (one bounce, so that truth is closed form).
cv::Vec3f white_at(int x, int y, int frame, std::vector<cv::Vec3f> const& albedos)
{
    auto const direct = [&](double px, double py) {
        double const dx = (px - 20 - 25 * frame) / 60, dy = (py - 30) / 60;
        return float(0.1 + 0.7 / (1 + dx * dx + dy * dy));
    };
    cv::Vec3f white = cv::Vec3f::all(direct(x, y));
    for (int j = 0; j < 5; ++j)
        if (j != patch_at(x, y))
            white += 0.12f * direct(20 + 40 * (j % 3), 22 + 45 * (j / 3)) * albedos[std::size_t(j)];
    return white;
}

std::vector<AlbedoView> frames(std::vector<cv::Vec3f> const& albedos, bool clean)
{
    Photometry const p = srgb_photometry();
    std::vector<AlbedoView> views;
    for (int frame = 0; frame < 4; ++frame) {
        AlbedoView v{cv::Mat(kSize, CV_32FC3), cv::Mat(kSize, CV_32FC3), cv::Mat(kSize, CV_32SC1), {}, {}, {}};
        cv::Mat noise(kSize, CV_32FC3);
        cv::RNG random{std::uint64_t(frame + 1)};
        random.fill(noise, cv::RNG::NORMAL, 0, clean ? 0 : 0.01);
        for (int y = 0; y < kSize.height; ++y)
            for (int x = 0; x < kSize.width; ++x) {
                int const patch = patch_at(x, y);
                v.surface.at<int>(y, x) = patch;
                v.white.at<cv::Vec3f>(y, x) = white_at(x, y, frame, albedos);
                cv::Vec3f const truth = patch < 0 ? cv::Vec3f(0, 0, 0) : kTruth[std::size_t(patch)];
                cv::Vec3f seen = truth.mul(white_at(x, y, frame, kTruth)) + noise.at<cv::Vec3f>(y, x);
                // A highlight on patch 0 that wanders, and one on patch 1 that clips.
                if (!clean && std::hypot(x - 15 - 6 * frame, y - 20) < 7) seen += cv::Vec3f::all(0.6f);
                if (!clean && std::hypot(x - 60 - 3 * frame, y - 22) < 9) seen += cv::Vec3f::all(3);
                v.radiance.at<cv::Vec3f>(y, x) = seen;
            }
        if (!clean) {
            cv::Mat const bytes = bytes_of(v.radiance, p);
            v.clipped = is_clipped(bytes);
            v.radiance = radiance_of(bytes, p);
        }
        views.push_back(v);
    }
    return views;
}

double largest_error(AlbedoFit const& fit)
{
    double worst = 0;
    for (std::size_t i = 0; i < kTruth.size(); ++i)
        for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(double(fit.patches[i].albedo[c]) / kTruth[i][c] - 1));
    return worst;
}

TEST(Albedo, OfKnownLightIsExact)
{
    AlbedoFit const fit = fit_albedo(frames(kTruth, true), kPatches);
    EXPECT_LT(largest_error(fit), 1e-5);
    EXPECT_EQ(fit.unseen, 1u);
    EXPECT_EQ(fit.patches[5].samples, 0u);
    EXPECT_EQ(fit.patches[5].albedo[0], 0.5f);
}

TEST(Albedo, ComesBackFromNoisyBytesWithHighlightsAndInterreflection)
{
    auto const render = [](std::vector<cv::Vec3f> const& albedos) { return frames(albedos, false); };
    AlbedoSolution const s = solve_albedo(render, kPatches);
    double const worst = largest_error(s.fit);
    std::cout << "largest error of an albedo " << 100 * worst << " % after " << s.iterations << " iterations; "
              << s.fit.clipped << " pixels clipped, " << s.fit.specular << " specular, " << s.fit.border
              << " at borders, " << s.fit.dark << " dark\n";
    double worst_by_value = 0;
    for (std::size_t i = 0; i < kTruth.size(); ++i)
        std::cout << "  " << s.fit.patches[i].albedo << " of " << kTruth[i] << "\n";
    for (std::size_t i = 0; i < kTruth.size(); ++i)
        for (int c = 0; c < 3; ++c)
            worst_by_value = std::max(worst_by_value, std::abs(double(s.fit.patches[i].albedo[c]) - kTruth[i][c]));
    EXPECT_LT(worst, 0.02);
    EXPECT_LT(worst_by_value, 0.005);
    EXPECT_TRUE(s.converged);
    EXPECT_GT(s.fit.clipped, 500u);
    EXPECT_GT(s.fit.specular, 100u);
    // Without turns, half-grey neighbours are wrong.
    EXPECT_GT(largest_error(fit_albedo(render(std::vector<cv::Vec3f>(6, {0.5f, 0.5f, 0.5f})), kPatches)), 0.03);
}

TEST(Albedo, IsClampedAndCounted)
{
    std::vector<AlbedoView> views = frames(kTruth, true);
    for (AlbedoView& v : views) {
        v.radiance *= 1.5;
        v.radiance.at<cv::Vec3f>(10, 10)[1] = std::numeric_limits<float>::quiet_NaN();
        v.white.rowRange(0, 5) = cv::Scalar::all(0);
    }
    AlbedoFit const fit = fit_albedo(views, kPatches);
    EXPECT_EQ(fit.clamped, 4u) << "patch 0 in three channels, patch 4 in one";
    EXPECT_EQ(fit.patches[0].albedo[0], 0.98f);
    EXPECT_EQ(fit.not_finite, 4u);
    EXPECT_EQ(fit.dark, 4u * 5 * 120);
    EXPECT_THROW(fit_albedo(views, 3), gi::InputError);
    views[0].white = cv::Mat();
    EXPECT_THROW(fit_albedo(views, kPatches), gi::InputError);
}

TEST(AlbedoTexture, ComesBackTexelByTexel)
{
    std::vector<AlbedoView> views = frames(kTruth, true);
    // Patch 0 gets a chequered texture of 8 x 8; the last two columns of texels are never seen.
    cv::Mat texture(8, 8, CV_32FC3);
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i)
            texture.at<cv::Vec3f>(j, i) = (i + j) % 2 ? cv::Vec3f(0.7f, 0.5f, 0.2f) : cv::Vec3f(0.1f, 0.3f, 0.6f);
    for (AlbedoView& v : views) {
        v.place = cv::Mat(kSize, CV_32FC2, cv::Scalar(-1, -1));
        for (int y = 0; y < 45; ++y)
            for (int x = 0; x < 40; ++x) {
                cv::Vec2f const at((float(x) + 0.5f) / 40 * 0.75f, (float(y) + 0.5f) / 45);
                v.place.at<cv::Vec2f>(y, x) = at;
                v.radiance.at<cv::Vec3f>(y, x) =
                    v.white.at<cv::Vec3f>(y, x).mul(texture.at<cv::Vec3f>(int(at[1] * 8), int(at[0] * 8)));
            }
    }
    AlbedoFit const fit = fit_albedo(views, kPatches);
    AlbedoTexture const found = fit_texture(views, 0, {8, 8}, fit.patches[0]);
    EXPECT_LT(cv::norm(found.albedo.colRange(0, 6), texture.colRange(0, 6), cv::NORM_INF), 1e-5);
    EXPECT_EQ(found.filled, 16u);
    EXPECT_EQ(found.albedo.at<cv::Vec3f>(3, 7), fit.patches[0].albedo);
    EXPECT_GT(found.samples.at<int>(3, 3), 50);
    EXPECT_THROW(fit_texture(views, 0, {0, 8}, fit.patches[0]), gi::InputError);
}

} // namespace
} // namespace ar::test
