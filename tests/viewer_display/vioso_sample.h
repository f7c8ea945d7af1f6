#pragma once
// Files of VIOSO.

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace viewer::test {

inline void put(std::string& text, std::uint32_t word)
{
    for (int k = 0; k < 4; ++k) text += char((word >> (8 * k)) & 0xff);
}
inline void put(std::string& text, float number) { put(text, std::bit_cast<std::uint32_t>(number)); }

/// Two rows of two pixels.
inline std::string vioso_mapping(std::string const& name, std::uint32_t flags, std::vector<float> const& records)
{
    std::string text = "vwf0";
    for (std::uint32_t const word : {380u, flags, 0u, std::uint32_t(4 * records.size()), 2u, 2u}) put(text, word);
    for (float const v : {1.0f, 1.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f}) put(text, v);
    text.resize(124);
    text += name;
    text.resize(380);
    for (float const v : records) put(text, v);
    return text;
}

/// A bitmap of 24 bits, rows from above where `rows` is negative.
inline std::string vioso_bitmap(int rows, std::vector<unsigned char> const& grey)
{
    std::string text = "BM";
    put(text, std::uint32_t(54 + 16));
    put(text, std::uint32_t(0));
    put(text, std::uint32_t(54));
    for (std::uint32_t const word : {40u, 2u, std::uint32_t(rows), 1u | 24u << 16, 0u, 16u, 0u, 0u, 0u, 0u})
        put(text, word);
    for (std::size_t row = 0; row < 2; ++row) {
        for (std::size_t k = 0; k < 6; ++k) text += char(grey[2 * row + k / 3]);
        text += std::string(2, '\0');
    }
    return text;
}

inline std::string vioso_set(std::string const& blocks)
{
    std::string text = "vwf1";
    for (std::uint32_t const word : {2u, 16u, 0u}) put(text, word);
    return text + blocks;
}

} // namespace viewer::test
