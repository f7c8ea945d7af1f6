#pragma once
#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>

namespace viewer {

/// Like CLI::Range, but rejects NaN and prints the limits in their shortest form.
inline CLI::Validator in_range(double low, double high)
{
    std::string const range = fmt::format("[{} - {}]", low, high);
    return CLI::Validator(
        [=](std::string& text) {
            double value = 0;
            if (!CLI::detail::lexical_cast(text, value) || std::isnan(value))
                return "Value " + text + " is not a number";
            return value >= low && value <= high ? std::string() : "Value " + text + " not in range " + range;
        },
        "FLOAT in " + range);
}

} // namespace viewer
