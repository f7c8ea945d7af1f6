#pragma once
// Parses numbers and lines of packets: strict, locale-independent, without exceptions.

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

namespace viewer {

/// Numbers of larger magnitude are rejected: trackers do not send them, and integers would no longer be exact.
inline constexpr double kLargestNumber = 1e15;

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\0'; }

inline std::string_view without_blanks(std::string_view text)
{
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

/// Removes and returns the next word of the text; empty = none left.
inline std::string_view take_word(std::string_view& text)
{
    text = without_blanks(text);
    std::size_t n = 0;
    while (n < text.size() && !is_blank(text[n])) ++n;
    std::string_view const word = text.substr(0, n);
    text.remove_prefix(n);
    return word;
}

/// Removes and returns the text before the next `at`, which is removed too; the whole text if there is none.
inline std::string_view take_until(std::string_view& text, char at)
{
    std::size_t const n = text.find(at);
    std::string_view const part = text.substr(0, n);
    text.remove_prefix(n == std::string_view::npos ? text.size() : n + 1);
    return part;
}

/// The whole word as a finite number with magnitude up to kLargestNumber.
inline std::optional<double> read_number(std::string_view word)
{
    double value = 0;
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    if (!(std::abs(value) <= kLargestNumber)) return std::nullopt;
    return value;
}

inline std::optional<std::uint64_t> read_count(std::string_view word)
{
    std::uint64_t value = 0;
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
}

} // namespace viewer
