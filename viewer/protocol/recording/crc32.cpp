#include "viewer/protocol/recording/crc32.h"

#include <array>

namespace viewer {
namespace {

constexpr std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t c = i;
        for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
        table[i] = c;
    }
    return table;
}();

} // namespace

std::uint32_t crc32(std::span<std::uint8_t const> bytes, std::uint32_t before)
{
    std::uint32_t c = ~before;
    for (std::uint8_t const b : bytes) c = kTable[(c ^ b) & 0xff] ^ (c >> 8);
    return ~c;
}

} // namespace viewer
