#pragma once
#include "gi/core/yaml.h"

#include <map>
#include <set>
#include <string>

namespace viewer {

/// The keys of every kind of mapping in a display file, by the name that data/display.schema.json gives to it.
std::map<std::string, std::set<std::string>> const& display_keys();
/// Throws unless all keys of the mapping belong to its kind.
inline void check_display_keys(gi::Yaml const& map, char const* kind) { map.only_keys(display_keys().at(kind)); }

} // namespace viewer
