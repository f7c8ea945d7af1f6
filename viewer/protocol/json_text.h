#pragma once
// JSON that others wrote.

#include <nlohmann/json.hpp>
#include <string_view>

namespace viewer {

/// Refuses nesting deeper than `most_levels`, since what prints, copies or compares a value later recurses.
/// Throws BadBytes (viewer/protocol/bytes.h).
nlohmann::json parse_json(std::string_view text, int most_levels = 32);
/// On one line; bytes that are no UTF-8 become U+FFFD.
std::string json_line(nlohmann::ordered_json const& value);

} // namespace viewer
