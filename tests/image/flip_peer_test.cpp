// Our FLIP against NVIDIA's own evaluator (flip-evaluator from PyPI, installed by scripts/setup --tests).

#include "gi/core/rng.h"
#include "gi/metrics/flip.h"

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
                p.image.push_back(
                    std::clamp(v * (1 + (x > 48 ? noise : 0)) + (y > 50 ? 0.02f : 0), 0.0f, brightest));
            }
    return p;
}

fs::path scratch(std::string const& name) { return fs::path(testing::TempDir()) / ("lightwell_flip_" + name); }

void write_raw(std::string const& name, std::vector<float> const& v)
{
    std::ofstream(scratch(name), std::ios::binary)
        .write(reinterpret_cast<char const*>(v.data()), std::streamsize(sizeof(float) * v.size()));
}

double mean_of(std::vector<float> const& v)
{
    double sum = 0;
    for (float const x : v) sum += double(x);
    return sum / double(v.size());
}

/// Mean of each pair by NVIDIA's evaluator, in one run of Python.
std::vector<double> peer_means(std::vector<Pair> const& pairs, std::vector<char const*> const& ranges)
{
    std::ofstream script(scratch("peer.py"));
    script << "import numpy, flip_evaluator\n"
              "def read(name, h, w): return numpy.fromfile(name, dtype=numpy.float32).reshape(h, w, 3)\n";
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        std::string const image = "image" + std::to_string(i), reference = "reference" + std::to_string(i);
        write_raw(image, pairs[i].image);
        write_raw(reference, pairs[i].reference);
        std::string const size =
            "', " + std::to_string(pairs[i].height) + ", " + std::to_string(pairs[i].width) + ")";
        script << "print('%.9g' % flip_evaluator.evaluate(read('" << scratch(reference).string() << size
               << ", read('" << scratch(image).string() << size << ", '" << ranges[i]
               << "', inputsRGB=False, parameters={'ppd': 67.02064})[1])\n";
    }
    script.close();
    std::string const command =
        "'" LIGHTWELL_SOURCE_DIR "/build/python/bin/python' '" + scratch("peer.py").string() + "'";
    std::vector<double> means(pairs.size(), -1.0);
    if (FILE* const pipe = popen(command.c_str(), "r"); pipe != nullptr) {
        for (double& mean : means)
            if (fscanf(pipe, "%lf", &mean) != 1) break;
        pclose(pipe);
    }
    return means;
}

TEST(FlipPeer, LdrAndHdrAgreeWithNvidiasEvaluator)
{
    if (!fs::exists(fs::path(LIGHTWELL_SOURCE_DIR) / "build" / "python" / "flip"))
        GTEST_SKIP() << "SKIPPED: flip-evaluator is not installed (scripts/setup --tests installs it from PyPI)";
    std::vector<Pair> const pairs{make_pair(0, 1),  make_pair(1, 1),  make_pair(2, 1),   make_pair(0, 40),
                                  make_pair(1, 40), make_pair(2, 40), make_pair(3, 2000)};
    std::vector<char const*> const ranges{"LDR", "LDR", "LDR", "HDR", "HDR", "HDR", "HDR"};
    std::vector<double> const theirs = peer_means(pairs, ranges);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        Pair const& p = pairs[i];
        bool const hdr = ranges[i] == std::string("HDR");
        auto const ours = hdr ? hdr_flip(p.image, p.reference, p.width, p.height)
                              : flip(p.image, p.reference, p.width, p.height);
        EXPECT_GT(theirs[i], 0.01) << i;
        EXPECT_NEAR(mean_of(ours), theirs[i], 1e-4) << ranges[i] << ", pair " << i;
    }
}

} // namespace
} // namespace gi::test
