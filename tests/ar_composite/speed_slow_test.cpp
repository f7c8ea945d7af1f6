// Prints how long composites take; checks only their bytes.

#include "ar/composite/blur.h"
#include "ar/composite/composite.h"
#include "ar/composite/occlusion_matte.h"
#include "ar/composite/temporal.h"
#include "ar/composite/upsample.h"
#include "ar/composite/warp.h"
#include "gi/core/quantile.h"
#include "tests/ar_composite/test_pictures.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <gtest/gtest.h>
#include <iostream>
#include <opencv2/imgproc.hpp>

namespace ar::test {
namespace {

struct Cost {
    double median_ms, least_ms, processor_ms; ///< of all threads: less dependent on who else works here
};

template <typename Work>
Cost cost_of(Work const& work, int times = 21)
{
    std::vector<double> ms;
    std::clock_t const before = std::clock();
    for (int i = 0; i < times; ++i) {
        auto const start = std::chrono::steady_clock::now();
        work();
        ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    double const processor = 1e3 * double(std::clock() - before) / CLOCKS_PER_SEC / times;
    std::sort(ms.begin(), ms.end());
    return {gi::quantile_of_sorted(ms, 0.5), ms.front(), processor};
}

std::ostream& operator<<(std::ostream& out, Cost const& c)
{
    return out << c.median_ms << " (" << c.least_ms << "), processor " << c.processor_ms;
}

cv::Mat smooth_radiance(cv::Size size, int seed)
{
    cv::Mat coarse = random_radiance(size / 40, seed), fine;
    cv::resize(coarse, fine, size, 0, 0, cv::INTER_CUBIC);
    return cv::Mat(cv::max(fine, 0.0));
}

/// A frame of a place: smooth, with the noise of a sensor.
cv::Mat usual_frame(cv::Size size)
{
    cv::Mat noise(size, CV_32FC3);
    cv::RNG random{2};
    random.fill(noise, cv::RNG::NORMAL, 0, 0.004);
    cv::Mat const light = smooth_radiance(size, 3) * 0.9 + noise;
    return bytes_of(light, srgb_photometry());
}

/// An object over 8 % of the frame, a change of light around it.
RenderedPair usual_pair(cv::Size size, double changed)
{
    RenderedPair pair = unchanged_pair(size);
    pair.without = smooth_radiance(size, 3);
    pair.with = pair.without.clone();
    cv::Point const middle(size.width / 2, size.height / 2);
    if (changed >= 1)
        pair.with *= 0.7;
    else {
        cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
        cv::circle(mask, middle, int(std::sqrt(changed * size.area() / 3.14159)), cv::Scalar(255), cv::FILLED);
        cv::Mat(pair.without * 0.7).copyTo(pair.with, mask);
    }
    cv::circle(pair.coverage, middle, int(std::sqrt(0.08 * size.area() / 3.14159)), cv::Scalar(1), cv::FILLED);
    smooth_radiance(size, 6).copyTo(pair.with, pair.coverage > 0);
    return pair;
}

TEST(CompositeSpeed, IsStated)
{
    Photometry bent = srgb_photometry();
    bent.vignetting = {-0.3, 0.05, -0.01};
    bent.colour = {1.2f, -0.1f, -0.1f, -0.05f, 1.1f, -0.05f, 0, -0.2f, 1.2f};
    CompositeSettings noisy;
    noisy.noise.constant = {1e-5f, 1e-5f, 1e-5f};
    noisy.noise.per_unit = {1e-4f, 1e-4f, 1e-4f};
    std::cout << cv::getNumThreads() << " threads; ms, median (least) of 21\n";
    for (cv::Size const size : {cv::Size(640, 480), cv::Size(1280, 720)}) {
        cv::Mat const camera = usual_frame(size);
        cv::Mat out;
        for (double const changed : {0.3, 1.0}) {
            RenderedPair const pair = usual_pair(size, changed);
            for (auto const& [name, composite] : {std::pair{"sRGB", Compositor(srgb_photometry())},
                                                  {"vignetting, colour", Compositor(bent)},
                                                  {"and noise", Compositor(bent, noisy)}}) {
                Compositor working = composite;
                Cost const cost = cost_of([&] { working(camera, pair, {}, out); });
                std::cout << size << ", " << 100 * changed << " % changed, " << name << ": " << cost << "\n";
            }
            Cost const cost = cost_of(
                [&] {
                    cv::Mat const seen = radiance_of(camera, bent);
                    cv::Mat const sum = seen + pair.with - pair.without;
                    out = bytes_of(sum, bent);
                },
                7);
            std::cout << "  step by step (radiance_of, sum, bytes_of): " << cost << "\n";
        }
        RenderedPair const pair = usual_pair(size, 0.3);
        CameraModel lens{
            LensModel::radial_tangential, {size.width, size.height}, 0.8 * size.width,     0.8 * size.width,
            size.width / 2 - 0.5,         size.height / 2 - 0.5,     {-0.2, 0.05, 0, 0, 0}};
        CameraModel const pinhole = covering_pinhole(lens);
        Warp const warp(lens, pinhole);
        RenderedPair const wide = usual_pair({pinhole.size_px.x, pinhole.size_px.y}, 0.3);
        cv::Mat const depth(size, CV_32FC1, cv::Scalar(2));
        CameraModel camera_model{LensModel::pinhole, {size.width, size.height}, 500, 500, 300, 200, {}};
        TemporalFilter filter(camera_model);
        RenderedPair const low = usual_pair(size / 2, 0.3);
        DirectlySeen const seen{cv::Mat::zeros(size, CV_32FC3), cv::Mat::zeros(size, CV_32FC1)};
        SurfaceGuides const guides{cv::Mat(size, CV_32FC3, cv::Scalar(0, 1, 0)), depth, {}};
        SurfaceGuides const low_guides{
            cv::Mat(size / 2, CV_32FC3, cv::Scalar(0, 1, 0)), cv::Mat(size / 2, CV_32FC1, cv::Scalar(2)), {}};
        cv::Mat const light = random_radiance(size, 9);
        cv::Mat hidden = pair.coverage.clone();
        hidden.colRange(0, size.width / 2) = 0;
        gi::RigidPose moved;
        auto const print = [&](char const* what, Cost const& cost) {
            std::cout << size << ", " << what << ": " << cost << "\n";
        };
        print("warp of a pair", cost_of([&] { warp(wide); }, 9));
        print("temporal filter", cost_of(
                                     [&] {
                                         moved.position.x += 0.003;
                                         filter(pair, depth, moved);
                                     },
                                     9));
        print("upsampling from half", cost_of([&] { upsampled(low, low_guides, seen, guides); }, 9));
        print("defocus of 0.8 px", cost_of([&] { defocused(pair, 0.8); }, 9));
        print("occlusion matte", cost_of([&] { refined_coverage(hidden, pair.coverage, light); }, 9));
    }
}

} // namespace
} // namespace ar::test
