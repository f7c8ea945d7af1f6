#include "viewer/protocol/bytes.h"

#include <bit>
#include <cmath>
#include <fmt/format.h>

namespace viewer {

void ByteWriter::put(std::uint64_t v, int size)
{
    for (int i = 0; i < size; ++i) bytes_.push_back(std::uint8_t(v >> (8 * i)));
}

void ByteWriter::put_count(std::uint64_t v)
{
    for (; v >= 0x80; v >>= 7) bytes_.push_back(std::uint8_t(v | 0x80));
    bytes_.push_back(std::uint8_t(v));
}

void ByteWriter::put_number(double v) { put_u64(std::bit_cast<std::uint64_t>(v)); }

void ByteWriter::put_numbers(std::span<double const> values, std::span<double const> defaults)
{
    std::size_t const mask = bytes_.size();
    bytes_.resize(mask + (values.size() + 7) / 8, 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::bit_cast<std::uint64_t>(values[i]) == std::bit_cast<std::uint64_t>(defaults[i])) continue;
        bytes_[mask + i / 8] |= std::uint8_t(1u << (i % 8));
        put_number(values[i]);
    }
}

void ByteWriter::put_text(std::string_view text)
{
    put_count(text.size());
    bytes_.insert(bytes_.end(), text.begin(), text.end());
}

std::span<std::uint8_t const> ByteReader::take(std::size_t size)
{
    if (size > rest_.size())
        throw BadBytes(fmt::format("they end where {} more are expected", size - rest_.size()));
    auto const taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
}

std::uint8_t ByteReader::byte() { return take(1)[0]; }

std::uint64_t ByteReader::get(int size)
{
    std::uint64_t v = 0;
    auto const bytes = take(std::size_t(size));
    for (int i = 0; i < size; ++i) v |= std::uint64_t(bytes[std::size_t(i)]) << (8 * i);
    return v;
}

std::uint64_t ByteReader::count(std::uint64_t most)
{
    std::uint64_t v = 0;
    for (int shift = 0;; shift += 7) {
        std::uint8_t const b = byte();
        if (shift == 63 && b > 1) throw BadBytes("a count has more than 64 bits");
        v |= std::uint64_t(b & 0x7f) << shift;
        if (b < 0x80) break;
    }
    if (v > most) throw BadBytes(fmt::format("a count is {}, the most is {}", v, most));
    return v;
}

double ByteReader::number()
{
    double const v = std::bit_cast<double>(u64());
    if (!std::isfinite(v)) throw BadBytes("a number is not finite");
    return v;
}

void ByteReader::numbers(std::span<double> values, std::span<double const> defaults)
{
    auto const mask = take((values.size() + 7) / 8);
    if (values.size() % 8 != 0 && mask.back() >> (values.size() % 8) != 0)
        throw BadBytes("there are more numbers than known");
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = (mask[i / 8] >> (i % 8) & 1) != 0 ? number() : defaults[i];
}

std::string ByteReader::text(std::size_t most_bytes)
{
    auto const bytes = take(std::size_t(count(most_bytes)));
    return {bytes.begin(), bytes.end()};
}

} // namespace viewer
