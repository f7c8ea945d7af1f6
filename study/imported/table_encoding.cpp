#include "study/imported/table_encoding.h"

#include "gi/core/text.h"
#include "study/script/script_error.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace study {
namespace {

constexpr char const* kSave = "save it as UTF-8 (of a spreadsheet: CSV UTF-8)";

void append(std::string& out, char32_t c)
{
    auto const add = [&](char32_t byte) { out += char(static_cast<unsigned char>(byte)); };
    if (c < 0x80)
        add(c);
    else if (c < 0x800) {
        add(0xc0 | (c >> 6));
        add(0x80 | (c & 0x3f));
    } else if (c < 0x10000) {
        add(0xe0 | (c >> 12));
        add(0x80 | ((c >> 6) & 0x3f));
        add(0x80 | (c & 0x3f));
    } else {
        add(0xf0 | (c >> 18));
        add(0x80 | ((c >> 12) & 0x3f));
        add(0x80 | ((c >> 6) & 0x3f));
        add(0x80 | (c & 0x3f));
    }
}

/// Place after some text, columns in bytes as those of cells.
void advance(Place& at, std::string_view text)
{
    for (char const c : text) at = c == '\n' ? Place{at.line + 1, 1} : Place{at.line, at.column + 1};
}

enum class ByteOrder { none, little, big };

ByteOrder utf16_order(std::string const& bytes)
{
    if (bytes.starts_with("\xff\xfe")) return ByteOrder::little;
    if (bytes.starts_with("\xfe\xff")) return ByteOrder::big;
    // Without a byte-order mark: the high bytes of separators, digits and line ends are 0.
    std::size_t const n = std::min<std::size_t>(bytes.size(), 4096) / 2;
    std::size_t even = 0, odd = 0;
    for (std::size_t i = 0; i < n; ++i) {
        even += bytes[2 * i] == '\0';
        odd += bytes[2 * i + 1] == '\0';
    }
    if (n < 2) return ByteOrder::none;
    if (odd > n / 2 && even == 0) return ByteOrder::little;
    return even > n / 2 && odd == 0 ? ByteOrder::big : ByteOrder::none;
}

std::string from_utf16(std::string const& bytes, ByteOrder order, std::string const& file)
{
    std::string out;
    Place at{1, 1};
    auto const refuse = [&](char const* problem) {
        throw ScriptError(file, at, problem, "the text is UTF-16, of which a part is missing", kSave);
    };
    auto const unit = [&](std::size_t i) {
        auto const first = static_cast<unsigned char>(bytes[i]), second = static_cast<unsigned char>(bytes[i + 1]);
        return char32_t(order == ByteOrder::little ? second * 256 + first : first * 256 + second);
    };
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
        if (i + 1 >= bytes.size()) refuse("the text ends within a character");
        char32_t c = unit(i);
        if (c >= 0xd800 && c < 0xe000) {
            char32_t const next = i + 3 < bytes.size() ? unit(i + 2) : 0;
            if (c >= 0xdc00 || next < 0xdc00 || next >= 0xe000) refuse("half of a character");
            c = 0x10000 + ((c - 0xd800) << 10) + (next - 0xdc00);
            i += 2;
        }
        if (c == 0xfeff) continue; // byte-order mark
        std::size_t const before = out.size();
        append(out, c);
        advance(at, std::string_view(out).substr(before));
    }
    return out;
}

/// Windows-1252 from 0x80 to 0x9f; 0 = there is none. The others are those of Latin-1.
constexpr std::array<char32_t, 32> kWindows{0x20ac, 0,      0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021,
                                            0x02c6, 0x2030, 0x0160, 0x2039, 0x0152, 0,      0x017d, 0,
                                            0,      0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014,
                                            0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0,      0x017e, 0x0178};

DecodedText from_windows(std::string const& bytes, Place first, std::string const& file)
{
    DecodedText out;
    Place at{1, 1};
    for (char const byte : bytes) {
        auto const value = static_cast<unsigned char>(byte);
        char32_t const c = value >= 0x80 && value < 0xa0 ? kWindows[value - 0x80u] : value;
        if (c == 0 && value != 0)
            throw ScriptError(file, at, "the text is neither UTF-8 nor Windows-1252",
                              fmt::format("byte 0x{:02x} is no character of either", value), kSave);
        append(out.text, c);
        at = byte == '\n' ? Place{at.line + 1, 1} : Place{at.line, at.column + 1};
    }
    out.note =
        fmt::format("{}:{}:{}: the text is not UTF-8: it is read as Windows-1252 (Latin-1); if names look wrong, "
                    "save it as UTF-8",
                    file, first.line, first.column);
    return out;
}

} // namespace

DecodedText decoded_table(std::string bytes, std::string const& file)
{
    DecodedText out;
    if (ByteOrder const order = utf16_order(bytes); order != ByteOrder::none)
        bytes = from_utf16(bytes, order, file);
    else if (bytes.starts_with("\xef\xbb\xbf"))
        bytes.erase(0, 3);
    Place at{1, 1};
    std::optional<Place> bad;
    bool has_others = false; // than ASCII that are UTF-8
    for (std::size_t i = 0; i < bytes.size();) {
        if (bytes[i] == '\0') throw ScriptError(file, at, "a zero byte", "tables are text", kSave);
        std::size_t const n = gi::first_character(std::string_view(bytes).substr(i));
        if (n == 0 && !bad) bad = at;
        has_others = has_others || n > 1;
        std::size_t const step = std::max<std::size_t>(n, 1);
        advance(at, std::string_view(bytes).substr(i, step));
        i += step;
    }
    if (bad && has_others)
        throw ScriptError(file, *bad, "the text is not UTF-8",
                          "it is elsewhere: parts of it have another encoding", kSave);
    if (bad) return from_windows(bytes, *bad, file);
    out.text = std::move(bytes);
    return out;
}

} // namespace study
