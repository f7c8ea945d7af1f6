#pragma once
// Lines, words and numbers of OBJ and MTL files.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace gi {

/// Lines without blanks at their ends. A line that ends with a backslash continues in the next.
class ObjLines {
public:
    explicit ObjLines(std::string_view text);
    /// @return false after the last one
    bool next();
    std::string_view line() const { return line_; }
    std::size_t number() const { return number_; } ///< from 1
    /// "line 12: problem"
    std::string at(std::string const& problem) const;

private:
    std::string_view take();

    std::string_view rest_, line_;
    std::string joined_; ///< a line of several
    std::size_t number_ = 0, taken_ = 0;
};

/// The number that a word begins with: "+.5", "2.e1", "1e-3,", "nan". Beyond the range of float: infinity. None of
/// "0,5": whoever wrote it meant a half.
std::optional<double> leading_number(std::string_view word);
/// The numbers that a line begins with, at most as many as fit. @return how many there are
std::size_t leading_numbers(std::string_view line, std::span<float> numbers);
std::size_t leading_numbers(std::string_view line, std::span<double> numbers);
/// " ('0,5' has a comma; write a decimal point)" if a word of the line is such a number, else empty.
std::string comma_advice(std::string_view line);
/// Without regard to upper and lower case. @param lower in lower case
bool equals_caseless(std::string_view word, std::string_view lower);

} // namespace gi
