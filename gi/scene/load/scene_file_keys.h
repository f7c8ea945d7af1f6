#pragma once
#include <map>
#include <set>
#include <string>

namespace gi {

/// The keys of every kind of mapping in a scene file, by the name that data/scene.schema.json gives to it.
std::map<std::string, std::set<std::string>> const& scene_file_keys();

} // namespace gi
