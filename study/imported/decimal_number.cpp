#include "study/imported/decimal_number.h"

#include "gi/core/text.h"

#include <algorithm>

namespace study {

std::optional<DecimalNumber> read_decimal(std::string_view text)
{
    if (text.starts_with('+') && text.size() > 1 && text[1] != '-') text.remove_prefix(1);
    if (auto const v = gi::parse_finite(text))
        return DecimalNumber{*v, text.find('.') == std::string_view::npos ? '\0' : '.'};
    std::size_t const comma = text.find(',');
    if (comma == std::string_view::npos || text.find('.') != std::string_view::npos) return {};
    std::string pointed(text);
    pointed[comma] = '.';
    auto const v = gi::parse_finite(pointed);
    if (!v) return {};
    std::string_view const whole =
        text.substr(text.starts_with('-') ? 1 : 0, comma - (text.starts_with('-') ? 1 : 0));
    std::string_view const rest = text.substr(comma + 1);
    bool const are_digits = std::all_of(rest.begin(), rest.end(), [](char c) { return c >= '0' && c <= '9'; });
    return DecimalNumber{*v, ',',
                         rest.size() == 3 && are_digits && !whole.empty() && whole.size() <= 3 && whole[0] != '0'};
}

} // namespace study
