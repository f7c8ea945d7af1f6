#include "gi/scene/load/obj_numbers.h"

#include "gi/core/text.h"

#include <vector>

namespace gi {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

} // namespace

std::optional<std::string> with_leading_zeros(std::string_view obj)
{
    std::vector<std::size_t> points; // that begin a number
    for (std::size_t begin = 0; begin < obj.size();) {
        std::size_t const end = std::min(obj.find('\n', begin), obj.size());
        std::size_t const first = std::min(obj.find_first_not_of(" \t", begin), end);
        if (first < end && obj[first] == 'v')
            for (std::size_t i = first + 1; i + 1 < end; ++i)
                if (obj[i] == '.' && is_blank(obj[i - 1]) && is_digit(obj[i + 1])) points.push_back(i);
        begin = end + 1;
    }
    if (points.empty()) return std::nullopt;
    std::string out;
    out.reserve(obj.size() + points.size());
    std::size_t from = 0;
    for (std::size_t const at : points) {
        out.append(obj, from, at - from).push_back('0');
        from = at;
    }
    return out.append(obj, from);
}

} // namespace gi
