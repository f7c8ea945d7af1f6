#pragma once
#include <string>
#include <string_view>

namespace gi {

/// As text or as a quoted attribute of HTML and SVG. Control characters become blanks.
inline std::string escaped(std::string_view text)
{
    std::string out;
    for (char const c : text) switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        case '\'':
            out += "&#39;";
            break;
        default:
            out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    return out;
}

} // namespace gi
