#pragma once
#include <string>
#include <string_view>

namespace gi {

/// SHA-256 (FIPS 180-4, by nettle) as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

} // namespace gi
