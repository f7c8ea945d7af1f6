#include "gi/core/shell.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace gi {

std::string shell_quoted(std::string const& word)
{
    bool const plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || std::string_view("-_./,:=+@%").find(char(c)) != std::string_view::npos;
    });
    if (plain) return word;
    std::string quoted = "'";
    for (char const c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

} // namespace gi
