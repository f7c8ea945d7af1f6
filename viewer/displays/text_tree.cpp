#include "viewer/displays/text_tree.h"

#include "gi/core/text.h"

#include <cmath>
#include <fmt/format.h>

namespace viewer {

TextNode const* TextNode::find(std::string const& wanted) const
{
    for (TextNode const& child : children)
        if (child.key == wanted) return &child;
    return nullptr;
}

std::string TextNode::text(std::string const& wanted, std::string const& otherwise) const
{
    TextNode const* const child = find(wanted);
    return child && !child->values.empty() ? child->values.front().text : otherwise;
}

std::vector<TextToken> tokens_of(std::string const& text, std::string const& marks, std::string const& file)
{
    if (text.size() > std::size_t(1) << 20)
        throw gi::InputError({file, 1, 1}, "the file is larger than 1 MiB", "configurations are small",
                             "is it the right file?");
    std::vector<TextToken> out;
    int line = 1;
    std::size_t line_start = 0;
    for (std::size_t i = 0; i < text.size();) {
        char const c = text[i];
        int const column = int(i - line_start) + 1;
        if (c == '\n') {
            ++line;
            line_start = ++i;
        } else if (c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f') {
            ++i;
        } else if (c == '#') {
            while (i < text.size() && text[i] != '\n') ++i;
        } else if (c == '"') {
            std::size_t const end = text.find_first_of("\"\n", i + 1);
            if (end == std::string::npos || text[end] == '\n')
                throw gi::InputError({file, line, column}, "a quote is not closed", "the text has no end",
                                     "end it with \"");
            out.push_back({text.substr(i + 1, end - i - 1), true, line, column});
            i = end + 1;
        } else if (c == '\'' && i + 2 < text.size() && text[i + 1] != '\n' && text[i + 2] == '\'') { // a character
            out.push_back({text.substr(i + 1, 1), true, line, column});
            i += 3;
        } else if (marks.find(c) != std::string::npos) {
            out.push_back({std::string(1, c), false, line, column});
            ++i;
        } else {
            std::size_t end = i;
            while (end < text.size() && std::string(" \t\r\n\v\f\"#").find(text[end]) == std::string::npos &&
                   marks.find(text[end]) == std::string::npos)
                ++end;
            out.push_back({text.substr(i, end - i), false, line, column});
            i = end;
        }
    }
    return out;
}

double number_of(TextToken const& token, std::string const& file)
{
    std::string const& s = token.text;
    auto const value = gi::parse_finite(std::string_view(s).substr(s.starts_with('+') ? 1 : 0));
    if (token.is_quoted || !value || std::abs(*value) > 1e12)
        throw gi::InputError({file, token.line, token.column}, "'" + s.substr(0, 64) + "' is not a number",
                             "a number is needed here", "write 1 or 0.5");
    return *value;
}

std::vector<double> numbers_of(TextNode const& node, std::size_t count, std::string const& file)
{
    if (node.values.size() != count)
        throw gi::InputError({file, node.line, node.column},
                             fmt::format("{} has {} values", node.key.substr(0, 64), node.values.size()),
                             fmt::format("{} numbers are needed", count), "write them all");
    std::vector<double> out;
    for (TextToken const& token : node.values) out.push_back(number_of(token, file));
    return out;
}

gi::dvec3 point_of(TextNode const& node, std::string const& file)
{
    auto const v = numbers_of(node, 3, file);
    return {v[0], v[1], v[2]};
}

} // namespace viewer
