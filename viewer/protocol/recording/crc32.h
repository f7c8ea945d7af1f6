#pragma once
#include <cstdint>
#include <span>

namespace viewer {

/// CRC-32 of ISO 3309 as in zlib and PNG: reflected, polynomial 0xEDB88320. `before` continues an earlier one.
std::uint32_t crc32(std::span<std::uint8_t const> bytes, std::uint32_t before = 0);

} // namespace viewer
