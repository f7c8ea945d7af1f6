#include "ar/capture/whole_picture.h"

#include "gi/core/crc32.h"
#include <algorithm>
#include <array>
#include <string_view>

namespace ar {
namespace {

constexpr std::array<std::uint8_t, 8> kPng{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

bool is_png(std::span<std::uint8_t const> p)
{
    return p.size() >= kPng.size() && std::equal(kPng.begin(), kPng.end(), p.begin());
}

std::uint32_t big_endian(std::uint8_t const* at)
{
    return std::uint32_t(at[0]) << 24 | std::uint32_t(at[1]) << 16 | std::uint32_t(at[2]) << 8 | at[3];
}

std::string missing_of_png(std::span<std::uint8_t const> png)
{
    for (std::size_t at = kPng.size();;) {
        if (png.size() - at < 12) return "the PNG ends before its last chunk";
        std::size_t const length = big_endian(&png[at]);
        if (length > png.size() - at - 12) return "the PNG ends within a chunk";
        auto const sum = gi::crc32({&png[at + 4], length + 4});
        if (sum != big_endian(&png[at + 8 + length])) return "a chunk of the PNG was changed (checksum)";
        if (big_endian(&png[at + 4]) == 0x49454e44) return {}; // IEND
        at += 12 + length;
    }
}

/// From one marker to the next; within a scan, bytes of 0xff are followed by 0 or are restart markers.
std::string missing_of_jpeg(std::span<std::uint8_t const> jpeg)
{
    for (std::size_t at = 2;;) {
        while (at + 1 < jpeg.size() && (jpeg[at] != 0xff || jpeg[at + 1] == 0xff)) ++at; // scan data, fill bytes
        if (at + 1 >= jpeg.size()) return "the JPEG ends before its end marker";
        std::uint8_t const marker = jpeg[at + 1];
        at += 2;
        if (marker == 0xd9) return {};                                      // EOI
        if (marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd7)) continue; // stuffed 0, TEM, restarts
        if (jpeg.size() - at < 2) return "the JPEG ends within a segment";
        std::size_t const length = std::size_t(jpeg[at]) << 8 | jpeg[at + 1];
        if (length < 2 || length > jpeg.size() - at) return "the JPEG ends within a segment";
        at += length;
    }
}

} // namespace

bool is_jpeg(std::span<std::uint8_t const> p)
{
    return p.size() >= 3 && p[0] == 0xff && p[1] == 0xd8 && p[2] == 0xff;
}

bool is_exr(std::span<std::uint8_t const> p)
{
    constexpr std::array<std::uint8_t, 4> kExr{0x76, 0x2f, 0x31, 0x01};
    return p.size() >= kExr.size() && std::equal(kExr.begin(), kExr.end(), p.begin());
}

bool is_picture(std::span<std::uint8_t const> p)
{
    using namespace std::string_view_literals;
    std::string_view const text(reinterpret_cast<char const*>(p.data()), p.size());
    bool const is_netpbm = text.size() > 2 && text[0] == 'P' && text[1] >= '1' && text[1] <= '6';
    bool const is_webp =
        text.starts_with("RIFF") && text.substr(std::min<std::size_t>(8, text.size())).starts_with("WEBP");
    return is_jpeg(p) || is_png(p) || is_netpbm || is_webp || text.starts_with("BM") ||
           text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv);
}

std::string what_is_missing(std::span<std::uint8_t const> p)
{
    if (is_jpeg(p)) return missing_of_jpeg(p);
    if (is_png(p)) return missing_of_png(p);
    return {};
}

} // namespace ar
