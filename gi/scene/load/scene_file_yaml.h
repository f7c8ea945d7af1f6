#pragma once
// YAML text as a small tree of values that know where they stand, read with limits: a short text must ask for
// neither a deep stack nor much memory (aliases are expanded and counted).

#include "gi/base/error.h"
#include "gi/base/math.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

inline constexpr std::size_t kMostYamlBytes = std::size_t(4) << 20;
inline constexpr std::size_t kMostYamlValues = 1'000'000; ///< with aliases expanded
inline constexpr std::size_t kDeepestYaml = 64;

struct YamlValue {
    enum class Kind : std::uint8_t { null, scalar, sequence, map };

    Kind kind = Kind::null;
    bool quoted = false;         ///< a quoted scalar is text even where it looks like a number
    std::string text;            ///< of a scalar
    std::vector<YamlValue> keys; ///< of a map: scalars, all different
    std::vector<YamlValue> items;
    std::shared_ptr<std::string const> file; ///< for messages
    int line = 0, column = 0;                ///< from 1
    std::size_t size = 1;                    ///< values in this tree

    InputError error(std::string const& problem, std::string const& why, std::string const& suggestion) const
    {
        return {TextLocation{*file, line, column}, problem, why, suggestion};
    }
};

/// The one document of a text. Throws InputError with its place on anything that is not one YAML document within
/// the limits, on keys that are no scalars and on duplicate keys.
YamlValue parse_yaml(std::string const& text, std::string const& name);

struct Range {
    double low, high; ///< both included
};

/// The functions below throw InputError with the place where the value is of another type or out of range; `what`
/// names it in the message.
double read_number(YamlValue const& value, std::string const& what, Range range);
std::uint64_t read_integer(YamlValue const& value, std::string const& what, Range range);
bool read_bool(YamlValue const& value, std::string const& what);
std::string read_text(YamlValue const& value, std::string const& what);
/// A list of exactly `count` numbers.
std::vector<double> read_numbers(YamlValue const& value, std::string const& what, std::size_t count, Range range);
dvec3 read_dvec3(YamlValue const& value, std::string const& what, Range range);
/// One number for all three, or a list of three.
dvec3 read_dvec3_or_number(YamlValue const& value, std::string const& what, Range range);
std::vector<YamlValue> const& read_list(YamlValue const& value, std::string const& what);

} // namespace gi
