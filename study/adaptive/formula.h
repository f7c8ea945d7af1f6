#pragma once
// Formulas of psychometric functions as text: P(correct) of named values, such as
// x, threshold, slope, guess, lapse in
//   guess + (1 - guess - lapse) * (1 - exp(-(x / threshold)^slope))
// Operators + - * / ^ (right-associative, before the sign), parentheses, numbers, pi, and the functions exp, log
// (natural), log2, log10, sqrt, abs, tanh, atan, erf, normal (the cumulative distribution), min(a, b), max(a, b).
// Nothing else is known: a formula cannot loop, call or read anything.

#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace study {

/// A text that is no formula. @see column
class FormulaError : public std::invalid_argument {
public:
    FormulaError(int column_, std::string problem_, std::string why_, std::string suggestion_);
    int column; ///< in the text, from 1
    std::string problem, why, suggestion;
};

/// The values of one level and one observer, in the order that psychometric functions of one setting take them.
inline constexpr std::array<char const*, 5> kPsychometricValues{"x", "threshold", "slope", "guess", "lapse"};

class Formula {
public:
    /// @param names   of the values that it may use
    /// @param needed  the first ones that it must use
    /// @throws FormulaError no formula, longer than 1000 characters, nested deeper than 25,
    /// or without a needed value
    Formula(std::string text, std::vector<std::string> names, std::size_t needed);
    /// P of x, threshold, slope, guess, lapse; it must use x and threshold.
    static Formula psychometric(std::string text);

    /// NaN or infinite where the formula is not defined. @param values  by name
    double operator()(std::span<double const> values) const;
    std::string const& text() const { return text_; }
    std::vector<std::string> const& names() const { return names_; }
    bool uses(std::size_t name) const; ///< @param name  index in names()

private:
    friend class FormulaParser;
    enum class Op : unsigned char {
        number,
        variable,
        negate,
        add,
        subtract,
        multiply,
        divide,
        power,
        call1,
        call2
    };
    struct Step {
        Op op = Op::number;
        double number = 0;
        int index = 0; ///< of a variable or function
    };

    std::string text_;
    std::vector<std::string> names_;
    std::vector<Step> steps_; ///< in postfix order
};

} // namespace study
