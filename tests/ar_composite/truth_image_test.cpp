// Composites against the picture with the object really there: a sphere on a chequered floor under a lamp, in
// closed form, seen by a camera with response, vignetting, blur and noise.

#include "ar/composite/blur.h"
#include "ar/composite/composite.h"
#include "tests/ar_composite/region.h"
#include "tests/ar_composite/test_pictures.h"

#include <cmath>
#include <cstdlib>
#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

cv::Size const kSize(320, 240);
glm::dvec3 const kSphere(0.05, -0.25, 1.5); ///< camera's frame, y down; the floor is at y = 0
constexpr double kRadius = 0.25;
glm::dvec3 const kEye(0, -0.7, 0), kLamp(-1.2, -2, 0.6);

/// Distance along the ray to the sphere, or 0.
double to_sphere(glm::dvec3 from, glm::dvec3 direction)
{
    glm::dvec3 const q = from - kSphere;
    double const b = glm::dot(q, direction), d = b * b - glm::dot(q, q) + kRadius * kRadius;
    if (d < 0) return 0;
    double const t = -b - std::sqrt(d);
    return t > 1e-6 ? t : 0;
}

cv::Vec3f floor_albedo(glm::dvec3 p)
{
    bool const dark = (int(std::floor(p.x / 0.2)) + int(std::floor(p.z / 0.2))) % 2 != 0;
    return dark ? cv::Vec3f(0.15f, 0.2f, 0.3f) : cv::Vec3f(0.7f, 0.6f, 0.5f);
}

/// 25 small lamps in a square, so that shadows are soft, and a sky.
double light_on(glm::dvec3 p, glm::dvec3 n, bool with_object)
{
    double sum = 0.25;
    for (int i = 0; i < 25; ++i) {
        glm::dvec3 const lamp = kLamp + glm::dvec3(0.1 * (i % 5 - 2), 0, 0.1 * (i / 5 - 2));
        glm::dvec3 const to = lamp - p, direction = glm::normalize(to);
        if (with_object && to_sphere(p + 1e-4 * n, direction) > 0) continue;
        sum += 6.0 / 25 * std::max(0.0, glm::dot(n, direction)) / glm::dot(to, to);
    }
    return sum;
}

struct Seen {
    cv::Vec3f radiance{0, 0, 0};
    bool object = false;
};

Seen ray(double x, double y, bool with_object, cv::Vec3f const* proxy)
{
    glm::dvec3 const d = glm::normalize(glm::dvec3((x - 159.5) / 260, (y - 119.5) / 260 + 0.35, 1));
    if (double const t = with_object ? to_sphere(kEye, d) : 0; t > 0) {
        glm::dvec3 const p = kEye + t * d, n = (p - kSphere) / kRadius;
        return {float(light_on(p, n, true)) * cv::Vec3f(0.5f, 0.15f, 0.1f), true};
    }
    if (!(d.y > 0)) return {{0.2f, 0.25f, 0.3f}, false};
    glm::dvec3 const p = kEye + (-kEye.y / d.y) * d;
    return {float(light_on(p, {0, -1, 0}, with_object)) * (proxy ? *proxy : floor_albedo(p)), false};
}

/// @param proxy  albedo of the floor as the model has it; null: the real one
void render(bool with_object, cv::Vec3f const* proxy, RenderedPair& pair)
{
    constexpr int kSub = 4;
    cv::Mat& radiance = with_object ? pair.with : pair.without;
    radiance.create(kSize, CV_32FC3);
    if (with_object) {
        pair.direct.create(kSize, CV_32FC3);
        pair.coverage.create(kSize, CV_32FC1);
    }
    cv::parallel_for_({0, kSize.height}, [&](cv::Range const& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < kSize.width; ++x) {
                cv::Vec3f sum(0, 0, 0), direct(0, 0, 0);
                int covered = 0;
                for (int i = 0; i < kSub * kSub; ++i) {
                    Seen const s = ray(x + (i % kSub + 0.5) / kSub - 0.5, y + (i / kSub + 0.5) / kSub - 0.5,
                                       with_object, proxy);
                    sum += s.radiance;
                    if (s.object) direct += s.radiance;
                    covered += s.object;
                }
                radiance.at<cv::Vec3f>(y, x) = sum * (1.0f / (kSub * kSub));
                if (!with_object) continue;
                pair.direct.at<cv::Vec3f>(y, x) = direct * (1.0f / (kSub * kSub));
                pair.coverage.at<float>(y, x) = float(covered) / (kSub * kSub);
            }
    });
}

struct Camera {
    Photometry photometry = srgb_photometry();
    double sigma_px = 0.8;
    SensorNoise noise;
    cv::Mat frame_of(cv::Mat const& radiance, std::uint64_t seed) const
    {
        cv::Mat seen;
        cv::GaussianBlur(radiance, seen, {9, 9}, sigma_px);
        cv::RNG random{seed};
        for (int y = 0; y < kSize.height; ++y)
            for (int x = 0; x < kSize.width; ++x) {
                float const fall_off = float(vignetting_at(photometry, kSize, x, y));
                for (int c = 0; c < 3; ++c) {
                    float& v = seen.at<cv::Vec3f>(y, x)[c];
                    v += float(random.gaussian(std::sqrt(noise.variance(c, v * fall_off)))) / fall_off;
                }
            }
        return bytes_of(seen, photometry);
    }
};

TEST(CompositeOfFrames, ComesNearTheTruth)
{
    Camera camera;
    camera.photometry.vignetting = {-0.35, 0.08, 0};
    camera.noise.constant = {1e-5f, 1e-5f, 1e-5f};
    camera.noise.per_unit = {5e-5f, 5e-5f, 5e-5f};
    RenderedPair pair;
    render(false, nullptr, pair);
    render(true, nullptr, pair);
    cv::Mat const frame = camera.frame_of(pair.without, 1), wanted = camera.frame_of(pair.with, 2);
    cv::Mat const region = affected_region(pair);

    auto const state = [&](char const* what, RenderedPair const& p, CompositeSettings const& settings,
                           cv::Mat& out) {
        CompositeCounts const counts = Compositor(camera.photometry, settings)(frame, p, {}, out, 3);
        CompositeError const e = errors_of(out, wanted, region);
        std::cout << what << ": rms " << e.inside.rms << " bytes where affected (" << e.inside.pixels << " px), "
                  << e.outside.rms << " elsewhere; clipped " << counts.clipped << ", negative " << counts.negative
                  << "\n";
        return e;
    };
    CompositeSettings plain, noisy;
    noisy.noise = camera.noise;
    CompositeSettings ratio = noisy;
    ratio.blend = Blend::ratio;
    cv::Mat out, best, by_ratio, by_difference;
    CompositeError const nothing = errors_of(frame, wanted, region);
    std::cout << "frame without the object: rms " << nothing.inside.rms << " where affected, "
              << nothing.outside.rms << " elsewhere (noise of two frames)\n";
    auto const sharp = state("sharp, no noise", pair, plain, out);
    RenderedPair const matched = defocused(pair, camera.sigma_px);
    auto const matched_error = state("matched blur and noise", matched, noisy, best);
    EXPECT_NEAR(matched_error.outside.rms, nothing.outside.rms, 0.05 * nothing.outside.rms) << "only noise";
    EXPECT_LT(matched_error.inside.rms, 0.75 * sharp.inside.rms);
    EXPECT_LT(matched_error.inside.rms, 1.5 * nothing.outside.rms);

    // A floor whose albedo the model does not know: the mean of the chequers, and that too dark by a third.
    cv::Vec3f const mean = 0.5f * (cv::Vec3f(0.15f, 0.2f, 0.3f) + cv::Vec3f(0.7f, 0.6f, 0.5f));
    for (float const factor : {1.0f, 0.67f}) {
        cv::Vec3f const proxy = factor * mean;
        RenderedPair rough;
        render(false, &proxy, rough);
        render(true, &proxy, rough);
        rough = defocused(rough, camera.sigma_px);
        std::cout << "floor of one albedo, times " << factor << "\n";
        auto const d = state("  difference", rough, noisy, by_difference);
        auto const r = state("  ratio", rough, ratio, by_ratio);
        EXPECT_LT(r.inside.rms, 0.25 * d.inside.rms);
    }
    if (char const* const folder = std::getenv("LIGHTWELL_TEST_PICTURES")) {
        cv::Mat top, bottom, all;
        cv::hconcat(std::vector<cv::Mat>{frame, best, wanted}, top);
        cv::hconcat(std::vector<cv::Mat>{out, by_difference, by_ratio}, bottom);
        cv::vconcat(top, bottom, all);
        cv::cvtColor(all, all, cv::COLOR_RGB2BGR);
        cv::imwrite(std::string(folder) + "/composite_truth.png", all);
    }
}

} // namespace
} // namespace ar::test
