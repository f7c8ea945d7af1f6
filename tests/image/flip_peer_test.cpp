// Our FLIP against NVIDIA's own evaluator (flip-evaluator from PyPI, installed by scripts/setup --tests).

#include "gi/base/picture_file.h"
#include "gi/base/rng.h"
#include "gi/image/flip.h"
#include "gi/image/tone_map.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

struct Pair {
    int width, height;
    std::vector<float> image, reference; ///< linear
};

/// Edges, gradients, noise and bright spots, and a disturbed copy.
Pair make_pair(std::uint64_t seed, float brightest)
{
    Pair p{96, 64, {}, {}};
    Pcg32 rng(seed, 1);
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x)
            for (int c = 0; c < 3; ++c) {
                float v = 0.5f + 0.4f * std::sin(0.05f * float((c + 1) * x) + 0.08f * float(y));
                if ((x / 16 + y / 16) % 2 == 0) v *= 0.4f;
                if ((x - 48) * (x - 48) + (y - 32) * (y - 32) < 60) v = brightest;
                float const noise = 0.15f * (rng.uniform() - 0.5f);
                p.reference.push_back(std::clamp(v, 0.0f, brightest));
                p.image.push_back(std::clamp(v * (1 + (x > 48 ? noise : 0)) + (y > 50 ? 0.02f : 0), 0.0f, brightest));
            }
    return p;
}

void write_raw(fs::path const& file, std::vector<float> const& v)
{
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<char const*>(v.data()), std::streamsize(4 * v.size()));
}

double peer_mean(Pair const& p, bool hdr)
{
    fs::path const folder = fs::path(testing::TempDir());
    write_raw(folder / "lightwell_flip_image.raw", p.image);
    write_raw(folder / "lightwell_flip_reference.raw", p.reference);
    std::string const script =
        "import numpy as n, flip_evaluator as f; r=lambda s: n.fromfile('" + folder.string() +
        "/lightwell_flip_'+s+'.raw',dtype=n.float32).reshape(" + std::to_string(p.height) + "," + std::to_string(p.width) +
        ",3); print('%.9g' % f.evaluate(r('reference'), r('image'), '" + (hdr ? "HDR" : "LDR") +
        "', inputsRGB=False, parameters={'ppd': 67.02064})[1])";
    std::string const command = std::string(LIGHTWELL_SOURCE_DIR) + "/build/python/bin/python -c \"" + script + "\"";
    FILE* const pipe = popen(command.c_str(), "r");
    double mean = -1;
    if (pipe == nullptr || fscanf(pipe, "%lf", &mean) != 1) mean = -1;
    if (pipe != nullptr) pclose(pipe);
    return mean;
}

double mean_of(std::vector<float> const& v)
{
    double sum = 0;
    for (float const x : v) sum += double(x);
    return sum / double(v.size());
}

TEST(FlipPeer, LdrAndHdrAgreeWithNvidiasEvaluator)
{
    if (!fs::exists(fs::path(LIGHTWELL_SOURCE_DIR) / "build" / "python" / "flip"))
        GTEST_SKIP() << "SKIPPED: flip-evaluator is not installed (scripts/setup --tests installs it from PyPI)";
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        Pair const ldr = make_pair(seed, 1), hdr = make_pair(seed, 40);
        double const ours = mean_of(flip(ldr.image, ldr.reference, ldr.width, ldr.height));
        double const theirs = peer_mean(ldr, false);
        EXPECT_GT(theirs, 0.01);
        EXPECT_NEAR(ours, theirs, 1e-4) << "LDR, seed " << seed;
        double const ours_hdr = mean_of(hdr_flip(hdr.image, hdr.reference, hdr.width, hdr.height));
        double const theirs_hdr = peer_mean(hdr, true);
        EXPECT_GT(theirs_hdr, 0.01);
        EXPECT_NEAR(ours_hdr, theirs_hdr, 1e-4) << "HDR, seed " << seed;
    }
}

} // namespace
} // namespace gi::test
