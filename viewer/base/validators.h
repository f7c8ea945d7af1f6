#pragma once
// Checks of option values, for CLI11.

#include "gi/core/text.h"
#include "gi/core/threads.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
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

/// For options of threads: reduces a number above the available threads to these, with a note on stderr.
inline CLI::Validator as_many_threads_as_there_are()
{
    return CLI::Validator(
        [](std::string& text) {
            auto const asked = gi::parse_finite(text);
            int const most = gi::available_threads();
            if (!asked || !(*asked > most) || *asked > 4096) return std::string();
            std::fputs(fmt::format("note: --threads {}: {} can run here, and are used\n", text, most).c_str(),
                       stderr);
            text = std::to_string(most);
            return std::string();
        },
        "");
}

} // namespace viewer
