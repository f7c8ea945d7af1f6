#pragma once
// Header and numbers of PLY files (Turk 1994, "The PLY Polygon File Format"): text, and binary of both byte orders.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
std::size_t bytes_of(PlyType type);
/// Largest value of an integer type, 1 for floats: what stands for full brightness.
double largest_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type;
    bool is_list = false;
    PlyType count_type = PlyType::uint8; ///< of a list
};

struct PlyElement {
    std::string name;
    std::uint64_t rows = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyFormat : std::uint8_t { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;  ///< in the order of the file
    std::vector<std::string> comments; ///< what follows `comment` and `obj_info`
    std::vector<std::string>
        unknown; ///< lines that are no part of a header: Blender 2.4 forgot the word `comment`
    std::size_t bytes = 0;             ///< up to the first value
    std::size_t lines = 0;
};

/// @throws std::runtime_error it is no header of PLY
PlyHeader read_ply_header(std::string_view file);

/// The values behind a header, one after the other.
class PlyValues {
public:
    PlyValues(std::string_view file, PlyHeader const& header)
        : format_(header.format), rest_(file.substr(header.bytes)), line_(header.lines + 1)
    {
    }

    /// @throws std::runtime_error the file ends, or has something else than a number
    double take(PlyType type);
    std::size_t bytes_left() const { return rest_.size(); }
    /// Fewest bytes of a value of this type.
    std::size_t least_bytes(PlyType type) const { return format_ == PlyFormat::ascii ? 2 : bytes_of(type); }

private:
    double take_word();

    PlyFormat format_;
    std::string_view rest_;
    std::size_t line_;
};

} // namespace gi
