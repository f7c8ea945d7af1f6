#pragma once
#include "gi/core/yaml.h"

#include <map>
#include <set>
#include <string>

namespace gi {

/// The keys of every kind of mapping in a scene file, by the name that data/scene.schema.json gives to it.
std::map<std::string, std::set<std::string>> const& scene_file_keys();
/// The keys that `generate` has for each kind of scene.
std::map<std::string, std::set<std::string>> const& keys_of_generated();
/// Throws unless all keys of the mapping belong to its kind.
inline void check_keys(Yaml const& map, char const* kind) { map.only_keys(scene_file_keys().at(kind)); }

} // namespace gi
