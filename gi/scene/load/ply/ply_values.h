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
        unknown;           ///< lines that are no part of a header: Blender 2.4 forgot the word `comment`
    std::size_t bytes = 0; ///< up to the first value
    std::size_t lines = 0;

    std::uint64_t rows() const; ///< of all elements with properties
};

/// @throws std::runtime_error it is no header of PLY
PlyHeader read_ply_header(std::string_view file);

/// The values behind a header, one after the other.
class PlyValues {
public:
    PlyValues(std::string_view file, PlyHeader const& header)
        : format_(header.format), rest_(file.substr(header.bytes)), line_(header.lines + 1)
    {
        has_row_a_line_ = is_text() && lines_left() >= header.rows();
    }

    /// @throws std::runtime_error the file ends, or has something else than a number
    double take(PlyType type);
    /// Begins a row of an element.
    void begin_row();
    /// Skips what else is on the last line of a row of text. Nothing is skipped if rows share lines.
    /// @return how many words these are @throws std::runtime_error they follow values of the row before
    std::size_t end_row();
    /// Skips blanks behind the last row. @return what follows: words of text, or bytes
    std::size_t count_left();
    std::size_t line() const { return line_; } ///< of text, from 1
    bool is_text() const { return format_ == PlyFormat::ascii; }
    std::size_t bytes_left() const { return rest_.size(); }
    /// Fewest bytes of a value of this type.
    std::size_t least_bytes(PlyType type) const { return format_ == PlyFormat::ascii ? 2 : bytes_of(type); }

private:
    double take_word();
    void skip_blanks();
    std::size_t lines_left() const;

    PlyFormat format_;
    std::string_view rest_;
    std::size_t line_;
    std::size_t row_line_ = 0;    ///< where the row begins
    bool has_row_a_line_ = false; ///< there are lines enough for all rows, as PLY has them
};

} // namespace gi
