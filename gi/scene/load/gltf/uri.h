#pragma once
#include <string>
#include <string_view>

namespace gi {

/// Decodes percent escapes of a URI: %41 becomes A; text that is not an escape stays.
std::string decode_percent(std::string_view text);

} // namespace gi
