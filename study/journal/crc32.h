#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace study {

/// The CRC-32 of gzip and PNG (ISO 3309, reflected polynomial 0xedb88320).
inline std::uint32_t crc32(std::string_view bytes)
{
    static constexpr auto kTable = [] {
        std::array<std::uint32_t, 256> table{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            std::uint32_t c = i;
            for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ ((c & 1) ? 0xedb88320u : 0u);
            table[i] = c;
        }
        return table;
    }();
    std::uint32_t crc = ~0u;
    for (char const c : bytes) crc = (crc >> 8) ^ kTable[(crc ^ static_cast<unsigned char>(c)) & 255];
    return ~crc;
}

} // namespace study
