// The seeds of every target of libFuzzer, each whole and in damaged copies:
// a target traps where its parser breaks a promise.

#include "tests/fuzz/targets.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <vector>

namespace {

using Bytes = std::vector<unsigned char>;

constexpr int kCopies = 400;           ///< damaged, of each seed
constexpr std::size_t kLongest = 4096; ///< bytes of a damaged copy, as in scripts/test -L fuzz

/// A few bytes changed, taken out or put in twice, or the end cut off.
Bytes damaged(Bytes bytes, std::mt19937& random)
{
    bytes.resize(std::min(bytes.size(), kLongest));
    for (int edits = 1 + int(random() % 8); edits > 0 && !bytes.empty(); --edits) {
        auto const at = bytes.begin() + std::ptrdiff_t(random() % bytes.size());
        auto const end =
            at + std::ptrdiff_t(1 + random() % std::min<std::size_t>(16, std::size_t(bytes.end() - at)));
        switch (random() % 5) {
        case 0:
            *at = static_cast<unsigned char>(random());
            break;
        case 1:
            *at = static_cast<unsigned char>(*at ^ (1u << random() % 8));
            break;
        case 2:
            bytes.erase(at, end);
            break;
        case 3: {
            Bytes const again(at, end);
            bytes.insert(at, again.begin(), again.end());
            break;
        }
        default:
            bytes.erase(end, bytes.end());
        }
    }
    return bytes;
}

class FuzzSeeds : public testing::TestWithParam<FuzzTarget> {};

TEST_P(FuzzSeeds, KeepThePromiseOfTheirParser)
{
    std::mt19937 random(20261123); // the same copies everywhere
    namespace fs = std::filesystem;
    fs::directory_iterator const folder(fs::path(LIGHTWELL_SOURCE_DIR) / "tests/fuzz/seeds" / GetParam().format);
    std::set<fs::path> const seeds(begin(folder), end(folder)); // in order
    for (fs::path const& file : seeds) {
        std::ifstream in(file, std::ios::binary);
        Bytes const seed(std::istreambuf_iterator<char>(in), {});
        EXPECT_EQ(GetParam().run(seed.data(), seed.size()), 0) << file;
        for (int copy = 0; copy < kCopies; ++copy) {
            Bytes const bytes = damaged(seed, random);
            EXPECT_EQ(GetParam().run(bytes.data(), bytes.size()), 0) << file << ", copy " << copy;
        }
    }
    EXPECT_FALSE(seeds.empty());
}

INSTANTIATE_TEST_SUITE_P(Of, FuzzSeeds, testing::ValuesIn(fuzz_targets().begin(), fuzz_targets().end()),
                         [](auto const& target) { return std::string(target.param.format); });

} // namespace
