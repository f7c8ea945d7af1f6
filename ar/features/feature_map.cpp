#include "ar/features/feature_map.h"

#include "gi/core/file.h"
#include "gi/core/text.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <opencv2/features2d.hpp>

namespace ar {
namespace {

constexpr std::string_view kFirstLine = "lightwell features 1";
constexpr std::size_t kLargestFile = std::size_t(1) << 30;
constexpr double kFar_m = 1e6;
constexpr int kCellsX = 12, kCellsY = 9;

int digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return -1;
}

Descriptor read_descriptor(gi::TextLine const& line, std::string_view word)
{
    Descriptor d{};
    bool good = word.size() == 2 * d.size();
    for (std::size_t k = 0; good && k < d.size(); ++k) {
        int const high = digit(word[2 * k]), low = digit(word[2 * k + 1]);
        good = high >= 0 && low >= 0;
        d[k] = std::uint8_t(16 * high + low);
    }
    if (!good)
        throw line.error(word, "this is no descriptor", "one has 64 digits 0-9 and a-f",
                         "make the map again: lightwell ar map");
    return d;
}

MapPoint read_point(gi::TextLine const& line)
{
    std::string_view rest = line.text;
    double values[4]{};
    for (int k = 0; k < 4; ++k) {
        std::string_view const word = gi::take_word(rest);
        auto const number = gi::parse_finite(word, kFar_m);
        if (!number || (k == 3 && *number < 0))
            throw line.error(word.empty() ? line.text : word,
                             fmt::format("'{}' is no {}", word, k < 3 ? "position" : "sigma"),
                             "a line is x y z sigma_m and descriptors", "make the map again: lightwell ar map");
        values[k] = *number;
    }
    MapPoint p{{values[0], values[1], values[2]}, values[3], {}};
    for (std::string_view word = gi::take_word(rest); !word.empty(); word = gi::take_word(rest))
        p.descriptors.push_back(read_descriptor(line, word));
    if (p.descriptors.empty() || p.descriptors.size() > kMostDescriptors)
        throw line.error(line.text, fmt::format("{} descriptors", p.descriptors.size()),
                         fmt::format("a point has 1 to {}", kMostDescriptors),
                         "make the map again: lightwell ar map");
    return p;
}

} // namespace

int hamming(Descriptor const& a, Descriptor const& b)
{
    std::uint64_t x[4], y[4];
    std::memcpy(x, a.data(), sizeof x);
    std::memcpy(y, b.data(), sizeof y);
    int sum = 0;
    for (int k = 0; k < 4; ++k) sum += std::popcount(x[k] ^ y[k]);
    return sum;
}

void check_size(FeatureMap const& map, std::string const& name)
{
    std::size_t descriptors = 0;
    for (MapPoint const& p : map.points) descriptors += p.descriptors.size();
    if (descriptors > kMostDescriptorsOfMap)
        throw gi::InputError(
            fmt::format("{} has {} points with {} descriptors", name, map.points.size(), descriptors),
            fmt::format("{} descriptors can be matched", kMostDescriptorsOfMap),
            "make a map of fewer frames (lightwell ar map --frames) or of a part of the place");
}

FeatureMap parse_feature_map(std::string_view text, std::string const& file)
{
    FeatureMap map;
    bool begun = false;
    for (int number = 1; !text.empty(); ++number) {
        gi::TextLine const line{gi::take_until(text, '\n'), file, number};
        std::string_view const content = gi::trimmed(line.text);
        if (content.empty() || content.front() == '#') continue;
        if (!begun) {
            if (content != kFirstLine)
                throw line.error(content, "this is no map of features",
                                 fmt::format("one begins with '{}'", kFirstLine),
                                 "make one: lightwell ar map SESSION --out map.txt");
            begun = true;
            continue;
        }
        map.points.push_back(read_point(line));
    }
    if (map.points.empty())
        throw gi::InputError(gi::TextLocation{file, 0, 0}, "there are no points", "nothing could be recognised",
                             "make a map of a place with texture: lightwell ar map SESSION --out map.txt");
    check_size(map, "'" + file + "'");
    return map;
}

FeatureMap read_feature_map(std::filesystem::path const& file)
{
    std::vector<unsigned char> const bytes = gi::read_bytes(file, kLargestFile);
    return parse_feature_map({reinterpret_cast<char const*>(bytes.data()), bytes.size()}, file.string());
}

std::string format_feature_map(FeatureMap const& map)
{
    std::string text = fmt::format("{}\n# x y z sigma_m descriptors\n", kFirstLine);
    for (MapPoint const& p : map.points) {
        text += fmt::format("{:.6f} {:.6f} {:.6f} {:.6f}", p.world_m.x, p.world_m.y, p.world_m.z, p.sigma_m);
        for (Descriptor const& d : p.descriptors) {
            text += ' ';
            for (std::uint8_t const b : d) text += fmt::format("{:02x}", b);
        }
        text += '\n';
    }
    return text;
}

PictureFeatures find_features(cv::Mat const& gray, int most)
{
    auto const orb = cv::ORB::create(4 * most, 1.2f, 8, 31, 0, 2, cv::ORB::HARRIS_SCORE, 31, 10);
    std::vector<cv::KeyPoint> all, kept;
    orb->detect(gray, all);
    std::stable_sort(all.begin(), all.end(),
                     [](cv::KeyPoint const& a, cv::KeyPoint const& b) { return a.response > b.response; });
    std::array<int, kCellsX * kCellsY> in_cell{};
    int const most_in_cell = std::max(1, most / (kCellsX * kCellsY));
    for (cv::KeyPoint const& k : all) {
        int const x = std::clamp(int(k.pt.x * kCellsX / float(gray.cols)), 0, kCellsX - 1),
                  y = std::clamp(int(k.pt.y * kCellsY / float(gray.rows)), 0, kCellsY - 1);
        if (in_cell[std::size_t(y * kCellsX + x)]++ < most_in_cell) kept.push_back(k);
    }
    cv::Mat descriptors;
    orb->compute(gray, kept, descriptors);
    PictureFeatures f;
    for (std::size_t k = 0; k < kept.size(); ++k) {
        f.pixels.emplace_back(kept[k].pt.x, kept[k].pt.y);
        f.sigma_px.push_back(0.5 * std::pow(1.2, kept[k].octave));
        Descriptor& d = f.descriptors.emplace_back();
        std::memcpy(d.data(), descriptors.ptr(int(k)), d.size());
    }
    return f;
}

} // namespace ar
