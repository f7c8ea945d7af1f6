#include "gi/scene/load/ply/ply_values.h"

#include "gi/core/text.h"
#include "gi/scene/load/obj/obj_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace gi {
namespace {

struct PlyTypeName {
    std::string_view name;
    PlyType type;
};
constexpr PlyTypeName kPlyTypes[]{
    {"char", PlyType::int8},       {"int8", PlyType::int8},      {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},     {"short", PlyType::int16},    {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},   {"uint16", PlyType::uint16},  {"int", PlyType::int32},
    {"int32", PlyType::int32},     {"uint", PlyType::uint32},    {"uint32", PlyType::uint32},
    {"int64", PlyType::int64},     {"uint64", PlyType::uint64},  {"float", PlyType::float32},
    {"float32", PlyType::float32}, {"double", PlyType::float64}, {"float64", PlyType::float64},
};

template <class T>
double value_of(unsigned char const* bytes, bool swapped)
{
    std::array<unsigned char, sizeof(T)> b;
    std::copy_n(bytes, sizeof(T), b.begin());
    if (swapped) std::ranges::reverse(b);
    return double(std::bit_cast<T>(b));
}

double value_of(PlyType type, unsigned char const* b, bool swapped)
{
    switch (type) {
    case PlyType::int8:
        return value_of<std::int8_t>(b, swapped);
    case PlyType::uint8:
        return value_of<std::uint8_t>(b, swapped);
    case PlyType::int16:
        return value_of<std::int16_t>(b, swapped);
    case PlyType::uint16:
        return value_of<std::uint16_t>(b, swapped);
    case PlyType::int32:
        return value_of<std::int32_t>(b, swapped);
    case PlyType::uint32:
        return value_of<std::uint32_t>(b, swapped);
    case PlyType::int64:
        return value_of<std::int64_t>(b, swapped);
    case PlyType::uint64:
        return value_of<std::uint64_t>(b, swapped);
    case PlyType::float32:
        return value_of<float>(b, swapped);
    case PlyType::float64:
        break;
    }
    return value_of<double>(b, swapped);
}

[[noreturn]] void header_fails(std::size_t line, std::string const& problem)
{
    throw std::runtime_error("line " + std::to_string(line) + " of its header: " + problem);
}

PlyType type_named(std::string_view name, std::size_t line)
{
    for (PlyTypeName const& known : kPlyTypes)
        if (equals_caseless(name, known.name)) return known.type;
    header_fails(line,
                 "'" + shortened(std::string(name), 40) + "' is no type of PLY, such as uchar, int or float");
}

std::string name_at_end(std::string_view rest, std::size_t line)
{
    std::string_view const name = take_word(rest);
    if (name.empty()) header_fails(line, "a name is missing");
    return std::string(name);
}

PlyProperty property_of(std::string_view rest, std::size_t line)
{
    PlyProperty p;
    std::string_view word = take_word(rest);
    p.is_list = equals_caseless(word, "list");
    if (p.is_list) {
        p.count_type = type_named(take_word(rest), line);
        if (p.count_type == PlyType::float32 || p.count_type == PlyType::float64)
            header_fails(line, "a list is counted by an integer");
        word = take_word(rest);
    }
    p.type = type_named(word, line);
    p.name = name_at_end(rest, line);
    return p;
}

PlyElement element_of(std::string_view rest, std::size_t line)
{
    PlyElement e;
    e.name = name_at_end(rest, line);
    take_word(rest);
    auto const rows = parse_number<std::uint64_t>(take_word(rest));
    if (!rows) header_fails(line, "'element " + shortened(e.name, 40) + "' needs the number of its rows");
    e.rows = *rows;
    return e;
}

PlyFormat format_of_ply(std::string_view rest, std::size_t line)
{
    std::string_view const name = take_word(rest);
    if (equals_caseless(name, "ascii")) return PlyFormat::ascii;
    if (equals_caseless(name, "binary_little_endian")) return PlyFormat::little_endian;
    if (equals_caseless(name, "binary_big_endian")) return PlyFormat::big_endian;
    header_fails(line, "'" + shortened(std::string(name), 40) +
                           "' is no format of PLY: ascii, binary_little_endian, binary_big_endian");
}

/// Lines up to `end_header`, without blanks at their ends; sets the size of the header. Binary values begin behind one
/// line end, and may look like another one.
std::vector<std::string_view> header_lines(std::string_view file, PlyHeader& header)
{
    std::size_t const first_end = std::min(file.find_first_of("\r\n"), file.size());
    bool const old_mac = first_end + 1 < file.size() && file[first_end] == '\r' && file[first_end + 1] != '\n';
    std::vector<std::string_view> lines;
    for (std::size_t at = 0; at < file.size();) {
        std::size_t const end = std::min(file.find(old_mac ? '\r' : '\n', at), file.size());
        lines.push_back(trimmed(file.substr(at, end - at)));
        at = std::min(end + 1, file.size());
        if (lines.back() != "end_header") continue;
        header.bytes = at;
        header.lines = lines.size();
        return lines;
    }
    throw std::runtime_error("its header has no line end_header");
}

} // namespace

std::size_t bytes_of(PlyType type)
{
    constexpr std::size_t kSizes[]{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return kSizes[std::size_t(type)];
}

double largest_of(PlyType type)
{
    if (type == PlyType::float32 || type == PlyType::float64) return 1;
    bool const is_signed = std::size_t(type) % 2 == 0;
    return std::exp2(double(8 * bytes_of(type)) - (is_signed ? 1 : 0)) - 1;
}

std::uint64_t PlyHeader::rows() const
{
    std::uint64_t all = 0;
    for (PlyElement const& e : elements)
        if (!e.properties.empty()) all += e.rows;
    return all;
}

PlyHeader read_ply_header(std::string_view file)
{
    PlyHeader header;
    std::vector<std::string_view> const lines = header_lines(file, header);
    if (!equals_caseless(lines[0], "ply")) header_fails(1, "it is not 'ply'");
    bool has_format = false;
    for (std::size_t n = 1; n + 1 < lines.size(); ++n) {
        std::string_view rest = lines[n];
        std::string_view const word = take_word(rest);
        if (word == "format") {
            header.format = format_of_ply(rest, n + 1);
            has_format = true;
        } else if (word == "comment" || word == "obj_info") {
            header.comments.emplace_back(trimmed(rest));
        } else if (word == "element") {
            header.elements.push_back(element_of(rest, n + 1));
        } else if (word == "property") {
            if (header.elements.empty()) header_fails(n + 1, "a property before the first element");
            header.elements.back().properties.push_back(property_of(rest, n + 1));
        } else if (!word.empty()) {
            header.unknown.push_back("line " + std::to_string(n + 1) + ": " +
                                     shortened(std::string(lines[n]), 60));
        }
    }
    if (!has_format) throw std::runtime_error("its header has no line format");
    return header;
}

double PlyValues::take(PlyType type)
{
    if (is_text()) return take_word();
    std::size_t const size = bytes_of(type);
    if (rest_.size() < size) throw std::runtime_error("the file ends early");
    bool const swapped = (format_ == PlyFormat::big_endian) != (std::endian::native == std::endian::big);
    double const value = value_of(type, reinterpret_cast<unsigned char const*>(rest_.data()), swapped);
    rest_.remove_prefix(size);
    return value;
}

void PlyValues::skip_blanks()
{
    std::size_t at = 0;
    for (; at < rest_.size() && (rest_[at] == '\n' || is_blank(rest_[at])); ++at) line_ += rest_[at] == '\n';
    rest_.remove_prefix(at);
}

/// Lines that are not blank.
std::size_t PlyValues::lines_left() const
{
    std::size_t lines = 0;
    for (std::string_view rest = rest_; !rest.empty();) lines += !trimmed(take_until(rest, '\n')).empty();
    return lines;
}

void PlyValues::begin_row()
{
    if (!has_row_a_line_) return;
    skip_blanks();
    row_line_ = line_;
}

std::size_t PlyValues::end_row()
{
    if (!has_row_a_line_) return 0;
    std::string_view line = rest_.substr(0, std::min(rest_.find('\n'), rest_.size()));
    rest_.remove_prefix(line.size());
    std::size_t words = 0;
    while (!gi::take_word(line).empty()) ++words;
    if (words > 0 && line_ != row_line_)
        throw std::runtime_error("line " + std::to_string(row_line_) +
                                 ": it has fewer values than its element's properties");
    return words;
}

std::size_t PlyValues::count_left()
{
    if (is_text()) skip_blanks();
    std::size_t words = 0;
    for (std::string_view rest = rest_; !rest.empty();)
        for (std::string_view line = take_until(rest, '\n'); !gi::take_word(line).empty();) ++words;
    return is_text() || words == 0 ? words : rest_.size();
}

double PlyValues::take_word()
{
    skip_blanks();
    std::size_t end = 0;
    while (end < rest_.size() && rest_[end] != '\n' && !is_blank(rest_[end])) ++end;
    std::string_view const word = rest_.substr(0, end);
    if (word.empty()) throw std::runtime_error("the file ends early");
    double value = 0;
    std::string_view const digits = word.starts_with('+') ? word.substr(1) : word;
    auto const [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    bool const too_long =
        error == std::errc::result_out_of_range; // value stays 0: below the least number, or above
    if ((error != std::errc{} && !too_long) || stop != digits.data() + digits.size())
        throw std::runtime_error("line " + std::to_string(line_) + ": '" + shortened(std::string(word), 40) +
                                 "' is no number");
    if (too_long && digits.find("e-") == digits.npos && digits.find("E-") == digits.npos)
        value = digits.starts_with('-') ? -std::numeric_limits<double>::infinity()
                                        : std::numeric_limits<double>::infinity();
    rest_.remove_prefix(end);
    return value;
}

} // namespace gi
