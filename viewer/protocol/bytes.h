#pragma once
// Bytes of messages and records, little-endian on every machine. The reader validates its input, which may be
// damaged, truncated or malicious.

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace viewer {

using Bytes = std::vector<std::uint8_t>;

/// Thrown by ByteReader with the reason why the bytes cannot be read.
/// A caller that knows their source turns it into an InputError.
struct BadBytes : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class ByteWriter {
public:
    void put_byte(std::uint8_t v) { bytes_.push_back(v); }
    void put_u32(std::uint32_t v) { put(v, 4); }
    void put_u64(std::uint64_t v) { put(v, 8); }
    /// LEB128: seven bits per byte, the lowest first; 1 to 10 bytes.
    void put_count(std::uint64_t v);
    /// All 64 bits, so that a double is restored exactly.
    void put_number(double v);
    /// A bit mask, in whole bytes, of the values that differ from their default in any bit; then those values.
    void put_numbers(std::span<double const> values, std::span<double const> defaults);
    /// The length (put_count), then the bytes.
    void put_text(std::string_view text);
    void put_raw(std::span<std::uint8_t const> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

    Bytes const& bytes() const { return bytes_; }
    Bytes take() { return std::move(bytes_); }

private:
    void put(std::uint64_t v, int size);
    Bytes bytes_;
};

/// Reads what a ByteWriter wrote. Each call throws BadBytes if too few bytes are left or a limit is exceeded.
class ByteReader {
public:
    /// @param bytes must outlive the reader
    explicit ByteReader(std::span<std::uint8_t const> bytes) : rest_(bytes) {}

    std::uint8_t byte();
    std::uint32_t u32() { return std::uint32_t(get(4)); }
    std::uint64_t u64() { return get(8); }
    std::uint64_t count(std::uint64_t most);
    /// Throws BadBytes if not finite.
    double number();
    void numbers(std::span<double> values, std::span<double const> defaults);
    std::string text(std::size_t most_bytes);
    std::span<std::uint8_t const> take(std::size_t size);

    std::size_t left() const { return rest_.size(); }

private:
    std::uint64_t get(int size);
    std::span<std::uint8_t const> rest_;
};

} // namespace viewer
