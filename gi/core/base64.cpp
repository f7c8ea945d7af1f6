#include "gi/core/base64.h"

#include <algorithm>
#include <cstdint>

namespace gi {

std::string encode_base64(std::span<unsigned char const> bytes)
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

std::optional<std::vector<unsigned char>> decode_base64(std::string_view text)
{
    while (text.ends_with('=')) text.remove_suffix(1);
    std::vector<unsigned char> out;
    out.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    int count = 0;
    for (char const c : text) {
        std::uint32_t value;
        if (c >= 'A' && c <= 'Z')
            value = std::uint32_t(c - 'A');
        else if (c >= 'a' && c <= 'z')
            value = std::uint32_t(c - 'a') + 26;
        else if (c >= '0' && c <= '9')
            value = std::uint32_t(c - '0') + 52;
        else if (c == '+')
            value = 62;
        else if (c == '/')
            value = 63;
        else
            return std::nullopt;
        bits = (bits << 6) | value;
        if ((count += 6) >= 8) {
            count -= 8;
            out.push_back(static_cast<unsigned char>(bits >> count));
        }
    }
    return out;
}

} // namespace gi
