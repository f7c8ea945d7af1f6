#include "gi/core/error.h"

namespace gi {
namespace {

std::string sentence(std::string const& problem, std::string const& why, std::string const& suggestion)
{
    std::string s = problem;
    if (!why.empty()) s += " (" + why + ")";
    if (!suggestion.empty()) s += " " + suggestion;
    return s;
}

std::string prefix(TextLocation const& where)
{
    std::string s = where.file;
    if (where.line > 0) s += ":" + std::to_string(where.line);
    if (where.line > 0 && where.column > 0) s += ":" + std::to_string(where.column);
    return s + ": ";
}

} // namespace

InputError::InputError(std::string const& problem, std::string const& why, std::string const& suggestion)
    : std::runtime_error(sentence(problem, why, suggestion))
{
}

InputError::InputError(TextLocation const& where, std::string const& problem, std::string const& why,
                       std::string const& suggestion)
    : std::runtime_error(prefix(where) + sentence(problem, why, suggestion))
{
}

} // namespace gi
