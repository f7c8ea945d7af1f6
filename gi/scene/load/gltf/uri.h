#pragma once
// Decoders of the two encodings used in glTF URIs.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

/// Decodes base64 (RFC 4648); returns nothing if the text has characters other than its alphabet and trailing '='.
std::optional<std::vector<unsigned char>> decode_base64(std::string_view text);
/// Decodes percent escapes: %41 becomes A; all other text is kept.
std::string decode_percent(std::string_view text);

} // namespace gi
