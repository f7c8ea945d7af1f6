#pragma once
// Limits the memory of light paths, structures that store their light, and impostors;
// checked before it is allocated.

#include <cstdint>
#include <string_view>

namespace gi {

inline constexpr std::uint64_t kMostBytes = std::uint64_t(8) << 30;
/// Throws InputError for more than kMostBytes. @param what  "lattices"  @param instead  "choose fewer cells"
void check_bytes(std::uint64_t bytes, std::string_view what, std::string_view instead);

} // namespace gi
