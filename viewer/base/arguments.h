#pragma once
// Parsers of command-line values. They throw InputError on invalid text; the message names `option`.

#include "gi/core/math.h"

#include <string>
#include <utility>

namespace viewer {

/// Parses "512x384": each from 1 to 65536, at most 2^28 pixels.
std::pair<int, int> parse_size(std::string const& text);
/// Parses "1,2.5,-3".
gi::dvec3 parse_point(std::string const& option, std::string const& text, std::string const& example = "1,1.6,-3");
/// Parses "0.2" (grey) or "0.9,0.5,0.1" (red, green, blue); numbers from 0 to 1e9.
gi::dvec3 parse_color(std::string const& option, std::string const& text);
/// Parses "500ms", "2s", "3min", "1h" or a plain number of seconds; must be > 0. Returns seconds.
double parse_duration(std::string const& option, std::string const& text);
/// Parses "NAME=VALUE", e.g. "relmse=0.001", for the given name and returns the value, which must be > 0.
double parse_target(std::string const& option, std::string const& text, std::string const& name);
/// Parses "flip=0.05" with any name.
std::pair<std::string, double> parse_limit(std::string const& option, std::string const& text,
                                           std::string const& example = "flip=0.05");

/// CLI11 check for 64-bit seeds. Needed because CLI11 wraps negative numbers and clamps too large ones.
/// Returns the problem; empty if there is none.
std::string check_seed(std::string const& text);

} // namespace viewer
