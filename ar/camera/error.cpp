#include "ar/camera/error.h"

namespace ar {
namespace {

std::string prefix(Place const& where)
{
    std::string s = where.file;
    if (where.line > 0) s += ":" + std::to_string(where.line);
    if (where.line > 0 && where.column > 0) s += ":" + std::to_string(where.column);
    return s + ": ";
}

} // namespace

InputError::InputError(std::string const& problem, std::string const& why, std::string const& suggestion)
    : std::runtime_error(problem + " (" + why + ") " + suggestion)
{
}

InputError::InputError(Place const& where, std::string const& problem, std::string const& why,
                       std::string const& suggestion)
    : std::runtime_error(prefix(where) + problem + " (" + why + ") " + suggestion)
{
}

} // namespace ar
