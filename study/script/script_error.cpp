#include "study/script/script_error.h"

#include <utility>

namespace study {
namespace {

std::string message(std::string const& file, Place where, std::string const& problem, std::string const& why,
                    std::string const& suggestion)
{
    std::string text = file;
    if (where.line > 0) text += ":" + std::to_string(where.line);
    if (where.line > 0 && where.column > 0) text += ":" + std::to_string(where.column);
    if (!text.empty()) text += ": ";
    text += problem;
    if (!why.empty()) text += " (" + why + ")";
    if (!suggestion.empty()) text += " " + suggestion;
    for (char& c : text) // names come from the script: a message stays one line
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    return text;
}

} // namespace

ScriptError::ScriptError(std::string file, Place where, std::string problem, std::string why,
                         std::string suggestion)
    : std::runtime_error(message(file, where, problem, why, suggestion)),
      file_(std::move(file)),
      where_(where),
      problem_(std::move(problem)),
      why_(std::move(why)),
      suggestion_(std::move(suggestion))
{
}

} // namespace study
