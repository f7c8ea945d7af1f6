#pragma once
// The keys that a display file may have; others are errors.

#include "gi/core/yaml.h"

#include <map>
#include <set>
#include <string>

namespace viewer {

/// The allowed keys of every kind of mapping in a display file, by the kind's name in data/display.schema.json.
std::map<std::string, std::set<std::string>> const& display_keys();
/// Throws if the mapping has a key that its kind does not allow.
inline void check_display_keys(gi::Yaml const& map, char const* kind) { map.only_keys(display_keys().at(kind)); }

} // namespace viewer
