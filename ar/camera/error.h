#pragma once
// What is wrong with a session, a calibration or what comes from a camera.

#include <stdexcept>
#include <string>

namespace ar {

/// Where in a text file something is wrong. Lines and columns count from 1; 0 = unknown.
struct Place {
    std::string file;
    int line = 0, column = 0;
};

/// The input or the call is wrong (exit code 2). Its text: "file:line:column: problem (why) suggestion".
class InputError : public std::runtime_error {
public:
    /// @param problem    what is wrong, naming the offending thing
    /// @param why        why that is a problem
    /// @param suggestion what to do instead
    InputError(std::string const& problem, std::string const& why, std::string const& suggestion);
    InputError(Place const& where, std::string const& problem, std::string const& why,
               std::string const& suggestion);
};

} // namespace ar
