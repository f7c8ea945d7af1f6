#pragma once
// CRC-32 checksums by zlib.

#include <cstdint>
#include <span>
#include <string_view>
#include <zlib.h>

namespace gi {

/// CRC-32 of ISO 3309, as in gzip and PNG. `before` continues an earlier one.
inline std::uint32_t crc32(std::span<unsigned char const> bytes, std::uint32_t before = 0)
{
    return std::uint32_t(::crc32_z(before, bytes.data(), bytes.size()));
}
inline std::uint32_t crc32(std::string_view bytes)
{
    return crc32({reinterpret_cast<unsigned char const*>(bytes.data()), bytes.size()});
}

} // namespace gi
