#pragma once
#include <string>
#include <string_view>

namespace gi {

/// %41 becomes A; what is not an escape stays.
std::string decode_percent(std::string_view text);

} // namespace gi
