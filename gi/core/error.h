#pragma once
// The error grammar of the whole program: "problem (why it is a problem) suggestion", with
// file:line:column where the input is text. The command line turns InputError into exit code 2.

#include <stdexcept>
#include <string>

namespace gi {

/// Where in a text file something is wrong. Lines and columns count from 1; 0 = unknown.
struct TextLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

/// The input or the call is wrong (exit code 2).
class InputError : public std::runtime_error {
public:
    /// @param problem    what is wrong, naming the offending thing
    /// @param why        why that is a problem
    /// @param suggestion what to do instead
    InputError(std::string const& problem, std::string const& why, std::string const& suggestion);
    InputError(TextLocation const& where, std::string const& problem, std::string const& why,
               std::string const& suggestion);
};

} // namespace gi
