#pragma once
// Values on the command line: each parser takes the text and the option it stands at, and throws InputError on
// nonsense.

#include "gi/core/math.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace viewer {

/// The whole text as a finite number, whatever the locale.
std::optional<double> to_number(std::string_view text);
/// "512x384": 1..65536 each, at most 2^28 pixels.
std::pair<int, int> parse_size(std::string const& text);
/// "1,2.5,-3"
gi::dvec3 parse_point(std::string const& option, std::string const& text, std::string const& example = "1,1.6,-3");
/// "0.2" or "0.9,0.5,0.1": three numbers from 0 to 1e9.
gi::dvec3 parse_color(std::string const& option, std::string const& text);
/// "500ms", "2s", "3min", or a plain number of seconds.
double parse_duration(std::string const& option, std::string const& text);
/// "relmse=0.001" for a known name; the value must be > 0.
double parse_target(std::string const& option, std::string const& text, std::string const& name);
/// "flip=0.05" of any name.
std::pair<std::string, double> parse_limit(std::string const& option, std::string const& text,
                                           std::string const& example = "flip=0.05");

/// A check for CLI11, whose unsigned numbers wrap around below 0 and stop at the largest of 64 bits: what is
/// wrong, empty = nothing.
std::string check_seed(std::string const& text);

} // namespace viewer
