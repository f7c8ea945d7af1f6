#include "tests/viewer_gl/surfaceless.h"
#include "viewer/devices/gl/ar_composite_pass.h"

#include "gi/core/error.h"

#include <chrono>
#include <cmath>
#include <epoxy/gl.h>
#include <iostream>
#include <limits>

namespace viewer::test {
namespace {

using ArCompositing = Surfaceless;

struct Input {
    cv::Mat camera;
    ar::RenderedPair pair;
};

/// All bytes; coverage of 0, 1 and between; a third unchanged, some not finite.
Input random_input(cv::Size size)
{
    cv::RNG random(11);
    Input in{cv::Mat(size, CV_8UC3),
             {cv::Mat(size, CV_32FC3), cv::Mat(size, CV_32FC3), cv::Mat(size, CV_32FC1, cv::Scalar(0))}};
    random.fill(in.camera, cv::RNG::UNIFORM, 0, 256);
    random.fill(in.pair.with, cv::RNG::UNIFORM, 0, 2);
    random.fill(in.pair.without, cv::RNG::UNIFORM, 0, 1.5);
    int const third = size.height / 3;
    in.pair.without.rowRange(0, third).copyTo(in.pair.with.rowRange(0, third));
    random.fill(in.pair.coverage.rowRange(2 * third, size.height), cv::RNG::UNIFORM, -0.2, 1.2);
    in.pair.with.at<cv::Vec3f>(third, 3)[1] = std::numeric_limits<float>::quiet_NaN();
    in.pair.without.at<cv::Vec3f>(third, 4)[0] = std::numeric_limits<float>::infinity();
    in.pair.coverage.at<float>(third, 5) = std::numeric_limits<float>::quiet_NaN();
    return in;
}

ar::Photometry bent_photometry()
{
    ar::Photometry p = ar::srgb_photometry();
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t b = 0; b < 256; ++b)
            p.unit_of_byte[c][b] = 1.2f * std::pow(float(b) / 255, 1.9f + 0.2f * float(c));
    p.vignetting = {-0.3, 0.05, -0.01};
    p.colour = {1.2f, -0.1f, -0.1f, -0.05f, 1.1f, -0.05f, 0, -0.2f, 1.2f};
    p.reference = {0.01, 1, 0, 0};
    return p;
}

TEST_F(ArCompositing, IsThatOfTheCpu)
{
    cv::Size const size(161, 120); // rows of RGB that are no multiples of 4
    Input in = random_input(size);
    ar::Exposure const exposure{0.012, 1, 0, 0};
    TextureTarget const target(TextureTarget::Format::bytes, {size.width, size.height});
    std::size_t differing = 0, all = 0;
    for (ar::Photometry const& p : {ar::srgb_photometry(), bent_photometry()})
        for (ar::Blend const blend : {ar::Blend::difference, ar::Blend::ratio})
            for (ar::ClippedBytes const clipped :
                 {ar::ClippedBytes::as_measured, ar::ClippedBytes::ratio, ar::ClippedBytes::model})
                for (bool const noisy : {false, true}) {
                    in.pair.direct = in.pair.direct.empty() ? cv::Mat(0.3 * in.pair.with) : cv::Mat();
                    ar::CompositeSettings settings;
                    settings.blend = blend;
                    settings.clipped = clipped;
                    if (noisy) settings.noise = {{1e-4f, 2e-4f, 1e-4f}, {1e-3f, 1e-3f, 1e-3f}, 0.7f, 3};
                    ar::Compositor compositor(p, settings);
                    cv::Mat expected;
                    compositor(in.camera, in.pair, exposure, expected, 17);
                    ArCompositePass pass(compositor);
                    pass.upload(in.camera, in.pair);
                    pass.draw(target.target(), exposure, 17);
                    auto const seen = read_bytes(target.target());
                    int largest = 0;
                    for (std::size_t i = 0; i < seen.size(); ++i) {
                        int const difference = std::abs(int(seen[i]) - int(expected.data[i]));
                        largest = std::max(largest, difference);
                        differing += difference != 0;
                    }
                    all += seen.size();
                    EXPECT_LE(largest, 1) << int(blend) << int(clipped) << noisy;
                    std::size_t const unchanged = 3 * 161 * 40;
                    EXPECT_TRUE(std::equal(seen.begin(), seen.begin() + unchanged, in.camera.data));
                }
    EXPECT_LT(double(differing), 1e-3 * double(all));
    std::cout << differing << " of " << all << " bytes differ, by at most 1\n";
}

TEST_F(ArCompositing, OfNothingIsTheFrameBitForBit)
{
    Input in = random_input({63, 49});
    in.pair.without.copyTo(in.pair.with);
    in.pair.coverage = cv::Scalar(0);
    ArCompositePass pass{ar::Compositor(bent_photometry())};
    // A part of a larger picture has gaps between its rows.
    cv::Mat larger(60, 70, CV_8UC3, cv::Scalar::all(9));
    cv::Mat const part = larger({4, 5, 63, 49});
    in.camera.copyTo(part);
    pass.upload(part, in.pair);
    TextureTarget const target(TextureTarget::Format::bytes, {63, 49});
    pass.draw(target.target(), {});
    auto const seen = read_bytes(target.target());
    EXPECT_TRUE(std::equal(seen.begin(), seen.end(), in.camera.data));
}

TEST_F(ArCompositing, RefusesTargetsOfAnotherSize)
{
    ArCompositePass pass{ar::Compositor(ar::srgb_photometry())};
    TextureTarget const target(TextureTarget::Format::bytes, {20, 10});
    EXPECT_THROW(pass.draw(target.target(), {}), gi::InputError) << "nothing uploaded";
    Input const in = random_input({21, 10});
    pass.upload(in.camera, in.pair);
    EXPECT_THROW(pass.draw(target.target(), {}), gi::InputError);
    EXPECT_THROW(pass.upload(in.camera.rowRange(0, 9), in.pair), gi::InputError);
}

TEST_F(ArCompositing, TimesAreStated)
{
    for (cv::Size const size : {cv::Size(640, 480), cv::Size(1280, 720)}) {
        Input const in = random_input(size);
        ArCompositePass pass{ar::Compositor(ar::srgb_photometry())};
        TextureTarget const target(TextureTarget::Format::bytes, {size.width, size.height});
        double best[2] = {1e9, 1e9};
        for (int i = 0; i < 5; ++i) {
            auto const start = std::chrono::steady_clock::now();
            pass.upload(in.camera, in.pair);
            glFinish();
            auto const uploaded = std::chrono::steady_clock::now();
            pass.draw(target.target(), {});
            glFinish();
            auto const drawn = std::chrono::steady_clock::now();
            best[0] = std::min(best[0], std::chrono::duration<double, std::milli>(uploaded - start).count());
            best[1] = std::min(best[1], std::chrono::duration<double, std::milli>(drawn - uploaded).count());
        }
        std::cout << gl->description() << ", " << size << ", least of 5: upload " << best[0] << " ms, draw "
                  << best[1] << " ms\n";
    }
}

} // namespace
} // namespace viewer::test
