#pragma once
// The keys that a scene file may have; others are errors.

#include "gi/core/yaml.h"

#include <map>
#include <set>
#include <string>

namespace gi {

/// Keys of every kind of mapping in a scene file, by its name in data/scene.schema.json.
std::map<std::string, std::set<std::string>> const& scene_file_keys();
/// Keys of `generate` for each kind of scene.
std::map<std::string, std::set<std::string>> const& keys_of_generated();
/// Throws unless all keys of the mapping belong to its kind.
inline void check_keys(Yaml const& map, char const* kind) { map.only_keys(scene_file_keys().at(kind)); }

} // namespace gi
