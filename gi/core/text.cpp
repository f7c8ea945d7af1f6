#include "gi/core/text.h"

#include <algorithm>

namespace gi {
namespace {

/// Within a character of UTF-8, not at its start.
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

} // namespace

std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string_view take_word(std::string_view& text)
{
    text = trimmed(text);
    std::string_view const word = text.substr(0, std::find_if(text.begin(), text.end(), is_blank) - text.begin());
    text.remove_prefix(word.size());
    return word;
}

std::string_view take_until(std::string_view& text, char at)
{
    std::size_t const n = text.find(at);
    std::string_view const part = text.substr(0, n);
    text.remove_prefix(n == std::string_view::npos ? text.size() : n + 1);
    return part;
}

std::vector<std::string_view> split_at_commas(std::string_view text)
{
    std::vector<std::string_view> fields;
    while (true) {
        std::size_t const n = text.find(',');
        std::string_view const field = text.substr(0, n), inner = trimmed(field);
        fields.push_back(inner.empty() ? field.substr(0, 0) : inner);
        if (n == std::string_view::npos) return fields;
        text.remove_prefix(n + 1);
    }
}

std::size_t first_character(std::string_view text)
{
    auto const byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    unsigned const first = byte(0);
    if (first < 0x80) return 1;
    std::size_t const count = first >= 0xc2 && first < 0xe0   ? 2
                              : first >= 0xe0 && first < 0xf0 ? 3
                              : first >= 0xf0 && first < 0xf5 ? 4
                                                              : 0;
    for (std::size_t i = 1; i < count; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    bool const is_overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
    bool const is_beyond = (first == 0xed && byte(1) >= 0xa0) || (first == 0xf4 && byte(1) >= 0x90);
    return is_overlong || is_beyond ? 0 : count;
}

std::size_t characters(std::string_view text)
{
    return text.size() - std::size_t(std::count_if(text.begin(), text.end(), continues));
}

std::string shortened(std::string const& text, std::size_t bytes)
{
    if (text.size() <= bytes) return text;
    std::size_t end = bytes - 3;
    while (end > 0 && continues(text[end])) --end;
    return text.substr(0, end) + "...";
}

std::string aligned(std::vector<std::vector<std::string>> const& rows, std::vector<bool> const& right,
                    std::size_t gap)
{
    std::vector<std::size_t> widths(right.size(), 0);
    for (auto const& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], characters(row[c]));
    std::string lines;
    for (auto const& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            std::string const blanks(widths[c] - characters(row[c]), ' ');
            line += (c > 0 ? std::string(gap, ' ') : "") + (right[c] ? blanks + row[c] : row[c] + blanks);
        }
        lines += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return lines;
}

} // namespace gi
