#pragma once
// Numbers as programs of several countries write them.

#include <optional>
#include <string>
#include <string_view>

namespace study {

struct DecimalNumber {
    double value = 0;
    char mark = '\0';         ///< '.' or ',' before the decimals; 0 = there is none
    bool may_be_1000 = false; ///< a comma as in "1,234", which some programs write between thousands
};

/// "0.5", "0,5", "-3", "1e-3"; empty if it is anything else, such as "1,234.5" or "1,234,567".
std::optional<DecimalNumber> read_decimal(std::string_view text);

} // namespace study
