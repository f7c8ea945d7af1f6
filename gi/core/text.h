#pragma once
// Numbers, words and lines of texts: strict, independent of the locale, without exceptions.

#include "gi/core/error.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

/// The whole text as a number, without blanks or '+'; empty if it is anything else or out of T's range.
template <class T>
std::optional<T> parse_number(std::string_view text)
{
    T value{};
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}
/// The same for finite numbers. @param largest magnitude
inline std::optional<double> parse_finite(std::string_view text,
                                          double largest = std::numeric_limits<double>::max())
{
    auto const value = parse_number<double>(text);
    return value && std::abs(*value) <= largest ? value : std::nullopt;
}

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\0'; }
/// Without blanks at its ends.
std::string_view trimmed(std::string_view text);
/// Removes and returns the next word of the text; empty = none left.
std::string_view take_word(std::string_view& text);
/// Removes and returns the text before the next `at`, which is removed too; the whole text if there is none.
std::string_view take_until(std::string_view& text, char at);
/// The parts between commas, trimmed; one at least.
std::vector<std::string_view> split_at_commas(std::string_view text);

/// A line of a file, for messages that name the place.
struct TextLine {
    std::string_view text;
    std::string const& file;
    int number; ///< from 1

    /// @param at part of the text
    InputError error(std::string_view at, std::string const& problem, std::string const& why,
                     std::string const& suggestion) const
    {
        return {TextLocation{file, number, int(at.data() - text.data()) + 1}, problem, why, suggestion};
    }
};

/// Bytes of the UTF-8 character at the front; 0 = there is none.
std::size_t first_character(std::string_view text);
/// Length of UTF-8 in characters.
std::size_t characters(std::string_view text);
/// Shortens UTF-8 to at most `bytes` bytes: cut between characters, with "..." at the end.
std::string shortened(std::string const& text, std::size_t bytes);
/// Lines of columns that are as wide as their widest cells, without blanks at the ends of lines.
/// @param right which columns are aligned at the right @param gap blanks between columns
std::string aligned(std::vector<std::vector<std::string>> const& rows, std::vector<bool> const& right,
                    std::size_t gap = 2);

} // namespace gi
