#include "viewer/batch/placeholders.h"

#include "gi/core/edit_distance.h"

#include <algorithm>

namespace viewer::batch {

std::string filled_in(std::string const& text, std::vector<Parameter> const& parameters, gi::Yaml const& where)
{
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char const c = text[i];
        if ((c == '{' || c == '}') && i + 1 < text.size() && text[i + 1] == c) {
            out += c;
            ++i;
            continue;
        }
        if (c == '}')
            throw where.error("'}' without '{' in '" + text + "'", "braces hold the name of a parameter",
                              "write }} for a brace");
        if (c != '{') {
            out += c;
            continue;
        }
        std::size_t const end = text.find('}', i);
        if (end == text.npos)
            throw where.error("'{' without '}' in '" + text + "'", "braces hold the name of a parameter",
                              "write {{ for a brace");
        std::string const name = text.substr(i + 1, end - i - 1);
        auto const found = std::ranges::find(parameters, name, &Parameter::first);
        if (found == parameters.end()) {
            std::vector<std::string> known;
            for (auto const& [parameter, unused] : parameters) known.push_back(parameter);
            throw where.error("there is no parameter '" + name + "'", "'" + text + "' uses it",
                              known.empty() ? "this group has none" : gi::suggest(name, known));
        }
        out += found->second;
        i = end;
    }
    return out;
}

} // namespace viewer::batch
