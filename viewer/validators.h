#pragma once
#include <CLI/CLI.hpp>

namespace viewer {

/// As CLI::Range, but NaN is outside too.
inline CLI::Validator in_range(double low, double high)
{
    CLI::Range const range(low, high);
    return CLI::Validator(
        [=](std::string& text) {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
            return range(text).empty() ? "Value " + text + " is not a number" : range(text);
        },
        range.get_description());
}

} // namespace viewer
