#pragma once
// The two encodings of glTF's URIs.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

/// RFC 4648; nothing where the text holds other characters than its alphabet and trailing '='.
std::optional<std::vector<unsigned char>> decode_base64(std::string_view text);
/// %41 becomes A; what is not an escape stays.
std::string decode_percent(std::string_view text);

} // namespace gi
