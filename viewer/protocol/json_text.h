#pragma once
// Parsing of untrusted JSON.

#include <nlohmann/json.hpp>
#include <string_view>

namespace viewer {

/// Throws BadBytes (viewer/protocol/bytes.h) on invalid JSON, or nesting deeper than `most_levels`, because
/// printing, copying and comparing a value recurse.
nlohmann::json parse_json(std::string_view text, int most_levels = 32);
/// The value on one line; bytes that are not UTF-8 become U+FFFD.
std::string json_line(nlohmann::ordered_json const& value);

} // namespace viewer
