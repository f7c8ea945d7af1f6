#pragma once
// The error type of the whole program. A message reads "file:line:column: problem (why) suggestion".

#include <stdexcept>
#include <string>

namespace gi {

/// A place in a text file. Lines and columns count from 1; 0 = unknown.
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
    /// Control characters become blanks: a message stays one line whatever the file holds.
    InputError(TextLocation where, std::string problem, std::string why, std::string suggestion);

    TextLocation const& where() const { return where_; }
    std::string const& problem() const { return problem_; }
    std::string const& why() const { return why_; }
    std::string const& suggestion() const { return suggestion_; }

private:
    TextLocation where_;
    std::string problem_, why_, suggestion_;
};

} // namespace gi
