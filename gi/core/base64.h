#pragma once
// Base64 (RFC 4648): bytes as printable text.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

/// RFC 4648, with padding.
std::string encode_base64(std::span<unsigned char const> bytes);
/// None where the text holds other characters than RFC 4648's alphabet and trailing '='.
std::optional<std::vector<unsigned char>> decode_base64(std::string_view text);

} // namespace gi
