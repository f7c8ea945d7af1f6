#pragma once
// Errors of the statistics for invalid input: "problem (why) suggestion".

#include <stdexcept>
#include <string>

namespace study {

/// @throws std::invalid_argument always
[[noreturn]] inline void refuse(std::string const& problem, std::string const& why, std::string const& suggestion)
{
    throw std::invalid_argument(problem + " (" + why + ") " + suggestion);
}

} // namespace study
