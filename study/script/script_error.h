#pragma once
// What is wrong with an experiment's script, and where. The same grammar as everywhere in the program:
// "file:line:column: problem (why it is a problem) suggestion".

#include <stdexcept>
#include <string>

namespace study {

/// Lines and columns count from 1; 0 = unknown.
struct Place {
    int line = 0;
    int column = 0;
};

/// The script, or what is asked of it, is wrong (exit code 2).
class ScriptError : public std::runtime_error {
public:
    /// @param problem    what is wrong, naming the offending thing
    /// @param why        why that is a problem
    /// @param suggestion what to do instead
    ScriptError(std::string file, Place where, std::string problem, std::string why, std::string suggestion);

    std::string const& file() const { return file_; }
    Place where() const { return where_; }
    std::string const& problem() const { return problem_; }
    std::string const& why() const { return why_; }
    std::string const& suggestion() const { return suggestion_; }

private:
    std::string file_;
    Place where_;
    std::string problem_, why_, suggestion_;
};

} // namespace study
