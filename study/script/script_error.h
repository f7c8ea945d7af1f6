#pragma once
// What is wrong with an experiment's script, its records, or what is asked of them.

#include "gi/core/error.h"

#include <utility>

namespace study {

/// Lines and columns count from 1; 0 = unknown.
struct Place {
    int line = 0;
    int column = 0;

    Place() = default;
    Place(int l, int c) : line(l), column(c) {}
    Place(gi::TextLocation const& at) : line(at.line), column(at.column) {}
};

class ScriptError : public gi::InputError {
public:
    explicit ScriptError(gi::InputError const& e) : InputError(e) {}
    ScriptError(std::string file, Place where, std::string problem, std::string why, std::string suggestion)
        : InputError(gi::TextLocation{std::move(file), where.line, where.column}, std::move(problem),
                     std::move(why), std::move(suggestion))
    {
    }
};

} // namespace study
