#include "gi/core/error.h"

#include <utility>

namespace gi {
namespace {

std::string message(TextLocation const& where, std::string const& problem, std::string const& why,
                    std::string const& suggestion)
{
    std::string text = where.file;
    if (where.line > 0) text += ":" + std::to_string(where.line);
    if (where.line > 0 && where.column > 0) text += ":" + std::to_string(where.column);
    if (!text.empty()) text += ": ";
    text += problem;
    if (!why.empty()) text += " (" + why + ")";
    if (!suggestion.empty()) text += " " + suggestion;
    return text;
}

std::string one_line(std::string text)
{
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    return text;
}

} // namespace

InputError::InputError(std::string const& problem, std::string const& why, std::string const& suggestion)
    : std::runtime_error(message({}, problem, why, suggestion)),
      problem_(problem),
      why_(why),
      suggestion_(suggestion)
{
}

InputError::InputError(TextLocation where, std::string problem, std::string why, std::string suggestion)
    : std::runtime_error(one_line(message(where, problem, why, suggestion))),
      where_(std::move(where)),
      problem_(std::move(problem)),
      why_(std::move(why)),
      suggestion_(std::move(suggestion))
{
}

} // namespace gi
