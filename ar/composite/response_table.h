#pragma once
// The response of one channel for composites: from byte to unit and back to the byte whose unit is nearest, with
// as little work as a picture at video rate allows. The GLSL pass has the same tables and the same rule.

#include <array>
#include <cstdint>

namespace ar {

class ResponseTable {
public:
    /// @param unit_of_byte  never falling
    explicit ResponseTable(std::array<float, 256> const& unit_of_byte);

    float unit(std::uint8_t byte) const { return unit_[byte]; }
    /// The byte whose unit is nearest; at the middle of two, the lower one. NaN: 0.
    std::uint8_t byte(float unit) const
    {
        if (!(unit > unit_[0])) return 0;
        if (unit >= unit_[255]) return 255;
        std::size_t b = first_[std::size_t((unit - unit_[0]) * scale_)];
        while (b < 255 && unit > border_[b]) ++b;
        return std::uint8_t(b);
    }
    /// The camera's own byte where it is a nearest one (of those with equal units each is), else as above.
    std::uint8_t byte_near(float unit, std::uint8_t camera) const
    {
        return unit >= least_[camera] && unit <= most_[camera] ? camera : byte(unit);
    }
    std::array<float, 256> const& units() const { return unit_; }
    /// [b]: the middle between the units of b and b + 1; [255] is the unit of 255.
    std::array<float, 256> const& borders() const { return border_; }
    /// Between which units a byte is a nearest one; infinite at the ends.
    std::array<float, 256> const& least() const { return least_; }
    std::array<float, 256> const& most() const { return most_; }
    /// By cell of unit, (unit - units()[0]) cells_per_unit() rounded down: a byte that is not above the nearest.
    static constexpr std::size_t kCells = 4096;
    std::array<std::uint8_t, kCells + 1> const& cells() const { return first_; }
    float cells_per_unit() const { return scale_; }

private:
    std::array<float, 256> unit_, border_, least_, most_;
    std::array<std::uint8_t, kCells + 1> first_;
    float scale_ = 0;
};

} // namespace ar
