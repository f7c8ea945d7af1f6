#include "viewer/displays/pixel_map.h"

#include "gi/core/claimed_size.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"
#include "gi/image_io/picture_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr std::size_t kMostMapBytes = std::size_t(1) << 30;
constexpr std::size_t kMostPixels = std::size_t(1) << 26; ///< of a picture of light: twice 8K

bool is_same(glm::vec3 const& a, glm::vec3 const& b)
{
    for (int k = 0; k < 3; ++k)
        if (a[k] != b[k] && !(std::isnan(a[k]) && std::isnan(b[k]))) return false;
    return true;
}

struct PfmHeader {
    int width = 0, height = 0;
    bool is_little_endian = true;
    std::size_t bytes = 0; ///< of the header
};

PfmHeader pfm_header(std::span<unsigned char const> bytes, std::string const& name)
{
    constexpr std::size_t kLongestWord = 32;
    std::size_t at = 0;
    int line = 1;
    auto const is_blank = [](unsigned char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    auto const bad = [&](std::string const& problem, std::string const& why) {
        return gi::InputError({name, line, 0}, problem, why,
                              "a PFM begins with PF, width and height, and -1 or 1 for its byte order");
    };
    auto const word = [&] {
        while (at < bytes.size() && is_blank(bytes[at])) line += bytes[at++] == '\n';
        std::string text;
        while (at < bytes.size() && !is_blank(bytes[at]) && text.size() < kLongestWord) text += char(bytes[at++]);
        if (text.empty() || at == bytes.size() || !is_blank(bytes[at]))
            throw bad("the header of a PFM is damaged", "it ends early, or a word is too long");
        return text;
    };
    if (bytes.size() < 3 || bytes[0] != 'P' || (bytes[1] != 'F' && bytes[1] != 'f'))
        throw bad("this is no PFM", "its first bytes are not PF");
    if (word() != "PF") throw bad("a PFM with one number a pixel", "positions have two or three");
    PfmHeader h;
    for (int* const side : {&h.width, &h.height}) {
        std::string const text = word();
        auto const value = gi::parse_finite(text);
        if (!value || *value != std::floor(*value) || *value < 2 || *value > kLargestMap_px)
            throw bad("a size of '" + text + "' px",
                      fmt::format("a side of a map has 2 to {} pixels", kLargestMap_px));
        *side = int(*value);
    }
    std::string const text = word();
    auto const scale = gi::parse_finite(text);
    if (!scale || *scale == 0) throw bad("a scale of '" + text + "'", "its sign is the byte order");
    h.is_little_endian = *scale < 0;
    h.bytes = at + 1;
    std::size_t const wanted = std::size_t(h.width) * std::size_t(h.height) * 12;
    if (bytes.size() - h.bytes != wanted)
        throw bad(fmt::format("{} bytes of pixels", bytes.size() - h.bytes),
                  fmt::format("{} x {} pixels are {} bytes", h.width, h.height, wanted));
    return h;
}

float float_of(unsigned char const* bytes, bool is_little_endian)
{
    std::uint32_t bits = 0;
    for (int k = 0; k < 4; ++k) bits |= std::uint32_t(bytes[k]) << (8 * (is_little_endian ? k : 3 - k));
    return std::bit_cast<float>(bits);
}

} // namespace

bool MapFile::operator==(MapFile const& other) const
{
    if (file != other.file || !map != !other.map) return false;
    return map == other.map || (map->width == other.map->width && map->height == other.map->height &&
                                std::ranges::equal(map->values, other.map->values, is_same));
}

bool has_value(glm::vec3 const& v) { return !std::isnan(v.x + v.y + v.z); }

std::optional<glm::dvec3> value_at(PixelMap const& map, glm::dvec2 uv)
{
    constexpr double kLeastWeight = 0.5;
    double const x = std::clamp(uv.x * map.width - 0.5, 0.0, map.width - 1.0),
                 y = std::clamp((1 - uv.y) * map.height - 0.5, 0.0, map.height - 1.0);
    int const column = std::min(int(x), map.width - 2), row = std::min(int(y), map.height - 2);
    glm::dvec3 sum{0};
    double weights = 0;
    for (int k = 0; k < 4; ++k) {
        int const i = column + k % 2, j = row + k / 2;
        double const weight = (1 - std::abs(x - i)) * (1 - std::abs(y - j));
        if (!(weight > 0) || !has_value(map.at(i, j))) continue;
        sum += weight * glm::dvec3(map.at(i, j));
        weights += weight;
    }
    if (weights < kLeastWeight) return {};
    return sum / weights;
}

PixelMap parse_pfm(std::span<unsigned char const> bytes, std::string const& name)
{
    PfmHeader const h = pfm_header(bytes, name);
    PixelMap map{h.width, h.height, {}};
    map.values.resize(std::size_t(h.width) * std::size_t(h.height));
    unsigned char const* from = bytes.data() + h.bytes;
    bool has_any = false;
    for (int y = h.height - 1; y >= 0; --y)
        for (int x = 0; x < h.width; ++x) {
            glm::vec3& v = map.values[std::size_t(y) * std::size_t(h.width) + std::size_t(x)];
            for (int k = 0; k < 3; ++k, from += 4) {
                v[k] = float_of(from, h.is_little_endian);
                if (std::isinf(v[k]))
                    throw gi::InputError({name, 0, 0},
                                         fmt::format("pixel ({}, {}) from the upper left is infinite", x, y),
                                         "it is a position", "write NaN for pixels that show nothing");
            }
            has_any |= !std::isnan(v.x) && !std::isnan(v.y);
        }
    if (!has_any)
        throw gi::InputError({name, 0, 0}, "no pixel has a position", "all are NaN", "export the map again");
    return map;
}

std::vector<unsigned char> pfm_bytes(PixelMap const& map)
{
    std::string const header = fmt::format("PF\n{} {}\n-1\n", map.width, map.height);
    std::vector<unsigned char> out(header.begin(), header.end());
    out.reserve(out.size() + map.values.size() * 12);
    for (int y = map.height - 1; y >= 0; --y)
        for (int x = 0; x < map.width; ++x)
            for (int k = 0; k < 3; ++k) {
                auto const bits = std::bit_cast<std::uint32_t>(map.at(x, y)[k]);
                for (int byte = 0; byte < 4; ++byte) out.push_back(static_cast<unsigned char>(bits >> (8 * byte)));
            }
    return out;
}

PixelMap parse_picture_positions(std::span<unsigned char const> bytes, std::string const& name)
{
    constexpr float kFarthest = 1e6f;
    PixelMap map = parse_pfm(bytes, name);
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        glm::vec3& v = map.values[i];
        if (std::isnan(v.x + v.y) || (v.x == 0 && v.y == 0)) {
            v = glm::vec3(std::nanf(""));
            continue;
        }
        if (!(std::abs(v.x) <= kFarthest && std::abs(v.y) <= kFarthest))
            throw gi::InputError(
                {name, 0, 0},
                fmt::format("pixel ({}, {}) from the upper left takes its colour from ({:g}, {:g})",
                            i % std::size_t(map.width), i / std::size_t(map.width), v.x, v.y),
                "the picture is 0 to 1", "write NaN for pixels that show nothing");
        v.z = 0; // an error estimate, or nothing
    }
    return map;
}

PixelMap parse_points(std::span<unsigned char const> bytes, double unit_m, std::string const& name)
{
    constexpr float kFarthest_m = 1e6f;
    PixelMap map = parse_pfm(bytes, name);
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        glm::vec3& v = map.values[i];
        if (!has_value(v) || v == glm::vec3(0)) {
            v = glm::vec3(std::nanf(""));
            continue;
        }
        v *= float(unit_m);
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(v[k]) <= kFarthest_m))
                throw gi::InputError({name, 0, 0},
                                     fmt::format("pixel ({}, {}) from the upper left lights a point {:g} m away",
                                                 i % std::size_t(map.width), i / std::size_t(map.width),
                                                 double(std::abs(v[k]))),
                                     "1000 km are handled", "is the unit right?");
    }
    return map;
}

PixelMap parse_light(std::span<unsigned char const> bytes, double gamma, std::string const& name)
{
    std::size_t const claimed = gi::claimed_pixels(bytes);
    if (claimed > kMostPixels)
        throw gi::InputError({name, 0, 0}, fmt::format("a picture of {} pixels", claimed),
                             fmt::format("a map of light has {} at most", kMostPixels),
                             "export a PNG of the viewport's size");
    gi::Picture const picture = gi::decode_stored(bytes, name);
    if (!picture.ends_at_one || picture.width > kLargestMap_px || picture.height > kLargestMap_px ||
        picture.width < 2 || picture.height < 2)
        throw gi::InputError(
            {name, 0, 0},
            picture.ends_at_one ? fmt::format("{} x {} pixels", picture.width, picture.height)
                                : "values of more than 16 bits",
            fmt::format("a map of light has 8 or 16 bits and sides of 2 to {} pixels", kLargestMap_px),
            "export a PNG of the viewport's size");
    gi::Layer const& color = picture.layers[0];
    PixelMap map{picture.width, picture.height, {}};
    map.values.reserve(picture.pixels());
    for (std::size_t i = 0; i < picture.pixels(); ++i)
        map.values.push_back(glm::pow(gi::rgb(color, i), glm::vec3(float(gamma))));
    return map;
}

std::vector<unsigned char> read_map_bytes(std::filesystem::path const& file)
{
    return gi::read_bytes(file, kMostMapBytes);
}

} // namespace viewer
