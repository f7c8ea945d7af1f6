#pragma once
// The keys that a study script may have; others are errors.

#include "gi/core/yaml.h"
#include "study/script/task.h"

#include <map>
#include <set>
#include <string>

namespace study {

/// Allowed keys of each kind of mapping in a script, by its name in data/study.schema.json.
std::map<std::string, std::set<std::string>> const& script_keys();
/// Throws unless all keys of the mapping belong to its kind.
inline void check_keys(gi::Yaml const& map, char const* kind) { map.only_keys(script_keys().at(kind)); }
/// Allowed keys of a block with this task; excludes keys that the task would not use.
std::set<std::string> block_keys(Task task);

} // namespace study
