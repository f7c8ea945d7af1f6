#include "viewer/bench/html.h"

#include "gi/base/error.h"
#include "gi/base/file.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>

namespace viewer {
namespace {

std::string base64(std::span<unsigned char const> bytes)
{
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::size_t const there = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < there ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= there ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

} // namespace

std::string escaped(std::string_view text)
{
    std::string out;
    for (char const c : text) {
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        case '\'':
            out += "&#39;";
            break;
        default:
            out += c;
        }
    }
    return out;
}

std::string readable(std::string const& column_name)
{
    std::string name = column_name;
    for (std::string_view const unit : {"_ms", "_s", "_bytes", "_deg"})
        if (name.ends_with(unit) && !name.ends_with("_per_s"))
            return readable(name.substr(0, name.size() - unit.size())) + ", " + std::string(unit.substr(1));
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

std::string embedded_png(std::filesystem::path const& file, std::string const& description)
{
    constexpr std::string_view kMark = "\x89PNG";
    constexpr std::size_t kMostBytes = std::size_t(64) << 20, kSize = 16; // where its width and height stand
    std::vector<unsigned char> bytes;
    try {
        bytes = gi::read_bytes(file, kMostBytes);
    } catch (gi::InputError const& e) {
        return fmt::format("<p class=\"missing\">{}</p>", escaped(e.what()));
    }
    if (bytes.size() < kSize + 8 ||
        !std::equal(kMark.begin(), kMark.end(), bytes.begin(),
                    [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; }))
        return fmt::format("<p class=\"missing\">{} is no PNG</p>", escaped(file.filename().string()));
    auto const word = [&](std::size_t at) {
        return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 |
               std::uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
    };
    return fmt::format(
        "<img tabindex=\"0\" width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">", word(kSize),
        word(kSize + 4), escaped(description), base64(bytes));
}

} // namespace viewer
