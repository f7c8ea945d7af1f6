#include "gi/scene/load/obj/obj_text.h"

#include "gi/core/math.h"
#include "gi/core/text.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace gi {

ObjLines::ObjLines(std::string_view text) : rest_(text)
{
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

/// The next line of the file; lines end with \n, \r or both.
std::string_view ObjLines::take()
{
    std::size_t const end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    std::string_view const line = rest_.substr(0, end);
    rest_.remove_prefix(end);
    if (!rest_.empty()) rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : 1);
    ++taken_;
    return line;
}

bool ObjLines::next()
{
    if (rest_.empty()) return false;
    number_ = taken_ + 1;
    line_ = take();
    if (line_.ends_with('\\') && !trimmed(line_).starts_with('#')) {
        joined_.clear();
        while (line_.ends_with('\\') && !rest_.empty()) {
            joined_ += line_.substr(0, line_.size() - 1);
            line_ = take();
        }
        joined_ += line_;
        line_ = joined_;
    }
    line_ = trimmed(line_);
    return true;
}

std::string ObjLines::at(std::string const& problem) const
{
    return "line " + std::to_string(number_) + ": " + problem;
}

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

template <typename Number>
std::size_t read_leading(std::string_view line, std::span<Number> numbers)
{
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        auto const number = leading_number(take_word(line));
        if (!number) return n;
        numbers[n] = Number(*number);
    }
    return numbers.size();
}

} // namespace

std::optional<double> leading_number(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{}) return std::nullopt;
    std::string_view const rest(end, std::size_t(word.data() + word.size() - end));
    if (rest.size() > 1 && rest[0] == ',' && is_digit(rest[1])) return std::nullopt;
    constexpr double kMost = std::numeric_limits<float>::max();
    return std::abs(value) > kMost ? std::copysign(double(kInf), value) : value;
}

std::size_t leading_numbers(std::string_view line, std::span<float> numbers)
{
    return read_leading(line, numbers);
}
std::size_t leading_numbers(std::string_view line, std::span<double> numbers)
{
    return read_leading(line, numbers);
}

std::string comma_advice(std::string_view line)
{
    for (std::string_view word; !(word = take_word(line)).empty();) {
        std::size_t const comma = word.find(',');
        if (comma != std::string_view::npos && comma > 0 && comma + 1 < word.size() && is_digit(word[comma - 1]) &&
            is_digit(word[comma + 1]))
            return " ('" + shortened(std::string(word), 40) + "' has a comma; write a decimal point)";
    }
    return {};
}

bool equals_caseless(std::string_view word, std::string_view lower)
{
    if (word.size() != lower.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i) {
        char const c = word[i];
        if ((c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c) != lower[i]) return false;
    }
    return true;
}

} // namespace gi
