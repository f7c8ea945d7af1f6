#pragma once
// Bytes of messages and records, little-endian on every machine. A reader checks before it reads: what it is given
// may be damaged, cut or hostile.

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace viewer {

using Bytes = std::vector<std::uint8_t>;

/// What a ByteReader throws: why the bytes cannot be read. Whoever knows what they are makes an InputError of it.
struct BadBytes : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class ByteWriter {
public:
    void put_byte(std::uint8_t v) { bytes_.push_back(v); }
    void put_u32(std::uint32_t v) { put(v, 4); }
    void put_u64(std::uint64_t v) { put(v, 8); }
    /// Seven bits a byte, the lowest first (LEB128): 1 to 10 bytes.
    void put_count(std::uint64_t v);
    /// All 64 bits, so that a double comes back exactly.
    void put_number(double v);
    /// One bit for each value that differs from its default in any bit, in whole bytes, then those values.
    void put_numbers(std::span<double const> values, std::span<double const> defaults);
    /// put_count of its length, then its bytes.
    void put_text(std::string_view text);
    void put_raw(std::span<std::uint8_t const> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

    Bytes const& bytes() const { return bytes_; }
    Bytes take() { return std::move(bytes_); }

private:
    void put(std::uint64_t v, int size);
    Bytes bytes_;
};

/// Reads what a ByteWriter wrote. Each call throws BadBytes where too few bytes are left or a limit is passed.
class ByteReader {
public:
    /// @param bytes must outlive the reader
    explicit ByteReader(std::span<std::uint8_t const> bytes) : rest_(bytes) {}

    std::uint8_t byte();
    std::uint32_t u32() { return std::uint32_t(get(4)); }
    std::uint64_t u64() { return get(8); }
    std::uint64_t count(std::uint64_t most);
    /// Finite.
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
