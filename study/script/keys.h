#pragma once
#include "gi/core/yaml.h"
#include "study/script/task.h"

#include <map>
#include <set>
#include <string>

namespace study {

/// The keys of every kind of mapping in a script, by the name that data/study.schema.json gives to it.
std::map<std::string, std::set<std::string>> const& script_keys();
/// Throws unless all keys of the mapping belong to its kind.
inline void check_keys(gi::Yaml const& map, char const* kind) { map.only_keys(script_keys().at(kind)); }
/// Those of a block with this task; a key that such a block would not use is none of them.
std::set<std::string> block_keys(Task task);

} // namespace study
