#pragma once
// Fast lookup tables for the response of one channel: from byte to unit and back to the byte with the nearest
// unit, at video rate. The GLSL pass uses the same tables and rule.

#include <array>
#include <cstdint>

namespace ar {

class ResponseTable {
public:
    using Code = std::uint8_t;
    static constexpr Code kWhite = 255;

    /// @param unit_of_byte  non-decreasing
    explicit ResponseTable(std::array<float, 256> const& unit_of_byte);

    float unit(std::uint8_t byte) const { return unit_[byte]; }
    /// The byte with the nearest unit; the lower one on ties. NaN: 0.
    std::uint8_t byte(float unit) const
    {
        if (!(unit > unit_[0])) return 0;
        if (unit >= unit_[255]) return 255;
        std::size_t b = first_[std::size_t((unit - unit_[0]) * scale_)];
        while (b < 255 && unit > border_[b]) ++b;
        return std::uint8_t(b);
    }
    /// The camera's own byte if it is a nearest one (several bytes may have the same unit), else as `byte`.
    std::uint8_t byte_near(float unit, std::uint8_t camera) const
    {
        return unit >= least_[camera] && unit <= most_[camera] ? camera : byte(unit);
    }
    /// The names that responses of other depths have too (deep_response.h).
    Code code(float unit) const { return byte(unit); }
    Code code_near(float unit, Code camera) const { return byte_near(unit, camera); }
    std::array<float, 256> const& units() const { return unit_; }
    /// [b]: midpoint between the units of b and b + 1; [255] is the unit of 255.
    std::array<float, 256> const& borders() const { return border_; }
    /// Range of units for which a byte is a nearest one; infinite at the ends.
    std::array<float, 256> const& least() const { return least_; }
    std::array<float, 256> const& most() const { return most_; }
    /// For each cell of units, floor((unit - units()[0]) cells_per_unit()): a byte not above the nearest one.
    static constexpr std::size_t kCells = 4096;
    std::array<std::uint8_t, kCells + 1> const& cells() const { return first_; }
    float cells_per_unit() const { return scale_; }

private:
    std::array<float, 256> unit_, border_, least_, most_;
    std::array<std::uint8_t, kCells + 1> first_;
    float scale_ = 0;
};

} // namespace ar
